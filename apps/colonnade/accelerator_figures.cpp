// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "accelerator_report.hpp"
#include "colonnade/accelerator/accelerator.hpp"
#include "rtl_measured.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kThesisClock_mhz = 100.0;

/// Clocks from the last pixel to the last line, but for lines that wait for others.
int tailBound(const AcceleratorModel& model) {
  const int words = model.size.width / model.pixels_per_clock;
  const int bins = 2 * rhoReach(model.size.width, model.size.height) + 1;
  return (4 + model.shape.hysteresis_passes) * words + bins + 60;
}

/// What an entry of measured.json found, without where it comes from.
Json found(const Json& measured, const std::string& name) {
  Json entry = measured.at("entries").at(name);
  for (const char* key : {"kind", "design", "what", "parameters", "rtl_sha256", "tools"})
    entry.erase(key);
  return entry;
}

Json resources(const Json& measured, const std::string& design, Json thesis,
               const std::string& title) {
  Json figure = {{"title", title},
                 {"thesis", std::move(thesis)},
                 {"ours", found(measured, design + ".operations")}};
  for (const char* family : {"xc6s", "xc7"}) {
    const std::string name = design + "." + family;
    if (measured.at("entries").contains(name)) figure[family] = found(measured, name);
  }
  return figure;
}

}  // namespace

Json acceleratorFigures(const std::vector<SoftwareTimes>& software,
                        const std::vector<HardwareTimes>& hardware, const std::string& picture) {
  const Json measured = Json::parse(kMeasuredRtl);
  const Json& any = measured.at("entries").front();
  Json figures = {{"rtl_sha256", any.at("rtl_sha256")},
                  {"tools", any.at("tools")},
                  {"configuration", "120x120, one pixel per clock"}};
  figures["figure_53"] = resources(measured, "canny",
                                   {{"adders_subtractors", 26},
                                    {"multipliers", 1},
                                    {"macs", 4},
                                    {"adder_trees", 5},
                                    {"counters", 3},
                                    {"register_bits", 539},
                                    {"comparators", 13},
                                    {"multiplexers", 17}},
                                   "Canny, one threshold");
  figures["figure_61"] = resources(measured, "hough_generic",
                                   {{"adders_subtractors", 29995},
                                    {"registers", 31158},
                                    {"comparators", 90602},
                                    {"multiplexers", 30260},
                                    {"tristates", 1440}},
                                   "Hough, 180 angles");
  figures["figure_67"] = resources(measured, "hough",
                                   {{"adders_subtractors", 14},
                                    {"counters", 996},
                                    {"register_bits", 1086},
                                    {"comparators", 3024},
                                    {"multiplexers", 1992}},
                                   "Hough, the thesis' twelve angles");
  figures["whole"] = {{"title", "all with four passes of hysteresis, queues and buses"},
                      {"xc6s", found(measured, "accelerator.xc6s")},
                      {"xc7", found(measured, "accelerator.xc7")}};
  figures["clock_rate"] = {{"thesis", {{"part", "Spartan-6"}, {"canny_mhz", 103.916}}}};
  for (const char* design : {"canny", "canny_hysteresis", "image_stage"}) {
    Json rate = found(measured, std::string(design) + ".ice40");
    rate["title"] = measured.at("entries").at(std::string(design) + ".ice40").at("what");
    figures["clock_rate"][design] = rate;
  }
  figures["picture"] = picture;
  figures["figure_72"] = {
      {"thesis", {{"size", "120x120"}, {"canny_ms", {1, 3}}, {"hough_ms", {7, 8}}}}};
  for (const SoftwareTimes& times : software) {
    const double opencv = times.opencv_canny_ms + times.opencv_hough_ms;
    figures["figure_72"]["ours"].push_back({{"size", sizeName(times.size)},
                                            {"opencv_canny_ms", times.opencv_canny_ms},
                                            {"opencv_hough_ms", times.opencv_hough_ms},
                                            {"opencv_ms", times.opencv_ms},
                                            {"fixed_ms", times.fixed_ms},
                                            {"fixed_faster", opencv / times.fixed_ms}});
  }
  figures["figure_73"] = {{"thesis",
                           {{"size", "120x120"},
                            {"clock_mhz", kThesisClock_mhz},
                            {"canny_ms", 0.36},
                            {"hough_ms", 0.144},
                            {"total_ms", 0.50767},
                            {"clocks", 50767}}}};
  for (const HardwareTimes& times : hardware) {
    const auto ms = [](double clocks) { return clocks / kThesisClock_mhz / 1000.0; };
    figures["figure_73"]["ours"].push_back(
        {{"size", sizeName(times.model.size)},
         {"pixels_per_clock", times.model.pixels_per_clock},
         {"angles", times.model.shape.angles_deg.size()},
         {"hysteresis_passes", times.model.shape.hysteresis_passes},
         {"lines", times.lines},
         {"canny_clocks", times.canny_clocks},
         {"clocks", times.clocks},
         {"clocks_after_last_pixel", times.tail_clocks},
         {"clocks_after_last_pixel_at_most", tailBound(times.model)},
         {"lines_that_wait", times.waiting_lines},
         {"sustained_clocks_per_frame", times.sustained_clocks},
         {"clock_mhz", kThesisClock_mhz},
         {"canny_ms", ms(times.canny_clocks)},
         {"hough_ms_more", ms(times.clocks - times.canny_clocks)},
         {"total_ms", ms(times.clocks)}});
  }
  return figures;
}

}  // namespace colonnade
