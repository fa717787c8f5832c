// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "accelerator_report.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

std::string shown(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return formatDouble(value.get<double>(), 4);
  if (value.is_array() && value.size() == 2) return shown(value[0]) + " to " + shown(value[1]);
  return value.dump();
}

/// A cell, "-" for what one side does not have.
std::string cell(const Json& object, const std::string& key) {
  return object.contains(key) ? shown(object.at(key)) : "-";
}

std::string row(const std::vector<std::string>& cells) {
  return "| " + joined(cells, " | ") + " |\n";
}

std::string header(const std::vector<std::string>& cells) {
  return row(cells) + row(std::vector<std::string>(cells.size(), "---"));
}

std::string operators(const Json& figure, const std::string& number) {
  std::string text = "\n**Figure " + number + "**: " + figure.at("title").get<std::string>() +
                     "\n\n" + header({"design", "thesis", "here"});
  for (const char* key :
       {"adders_subtractors", "macs", "adder_trees", "multipliers", "counters", "registers",
        "register_bits", "comparators", "multiplexers", "tristates"}) {
    std::string name = key;
    for (char& letter : name) letter = letter == '_' ? ' ' : letter;
    if (figure.at("thesis").contains(key) || figure.at("ours").contains(key))
      text += row({name, cell(figure.at("thesis"), key), cell(figure.at("ours"), key)});
  }
  return text;
}

std::string mapped(const Json& figures) {
  std::string text = "\n**Mapped**, yosys, before place and route\n\n" +
                     header({"design", "family", "LUT", "shift-register LUT", "flip-flops",
                             "block memories (half, whole)", "DSP"});
  for (const char* name : {"figure_53", "figure_61", "figure_67", "whole"}) {
    for (const char* family : {"xc6s", "xc7"}) {
      if (!figures.at(name).contains(family)) continue;
      const Json& used = figures.at(name).at(family);
      text += row({figures.at(name).at("title").get<std::string>(), family, cell(used, "lut"),
                   cell(used, "shift_register_lut"), cell(used, "flip_flop"),
                   cell(used, "block_memory_half") + ", " + cell(used, "block_memory_whole"),
                   cell(used, "dsp")});
    }
  }
  return text;
}

std::string rates(const Json& rates) {
  std::string text = "\n**Clock rate**\n\n" +
                     header({"design", "part", "MHz", "of seeds", "logic cells", "memories"}) +
                     row({"thesis, Canny", cell(rates.at("thesis"), "part"),
                          cell(rates.at("thesis"), "canny_mhz"), "-", "-", "-"});
  for (const auto& [name, rate] : rates.items()) {
    if (name == "thesis") continue;
    std::vector<std::string> seeds;
    for (const Json& mhz : rate.at("seeds_mhz")) seeds.push_back(formatFixed(mhz.get<double>(), 1));
    const auto of = [&](const char* key) {
      return rate.at(key)[0].dump() + " of " + rate.at(key)[1].dump();
    };
    text += row({rate.at("title").get<std::string>(), cell(rate, "part"),
                 formatFixed(rate.at("median_mhz").get<double>(), 1), joined(seeds, " "),
                 of("logic_cells"), of("block_memories")});
  }
  return text;
}

}  // namespace

std::string acceleratorTables(const Json& figures) {
  std::string text = "Resources: yosys " + figures.at("tools").at("yosys").get<std::string>() +
                     ", nextpnr-ice40 " +
                     figures.at("tools").at("nextpnr-ice40").get<std::string>() + "; " +
                     figures.at("configuration").get<std::string>() + "\n";
  text += operators(figures.at("figure_53"), "53") + operators(figures.at("figure_61"), "61") +
          operators(figures.at("figure_67"), "67") + mapped(figures) +
          rates(figures.at("clock_rate"));

  text += "\n**Figure 72**: software, ms of processor time (" +
          figures.at("picture").get<std::string>() + ")\n\n" +
          header({"implementation", "size", "Canny", "Hough, 180 angles", "`opencv`, all",
                  "`fixed`, all", "Canny and Hough / `fixed`"});
  const Json& software = figures.at("figure_72");
  text += row({"thesis", "120x120", cell(software.at("thesis"), "canny_ms"),
               cell(software.at("thesis"), "hough_ms"), "-", "-", "-"});
  for (const Json& times : software.at("ours"))
    text += row({"OpenCV here", cell(times, "size"), cell(times, "opencv_canny_ms"),
                 cell(times, "opencv_hough_ms"), cell(times, "opencv_ms"), cell(times, "fixed_ms"),
                 formatFixed(times.at("fixed_faster").get<double>(), 1)});

  const Json& hardware = figures.at("figure_73");
  const Json& thesis = hardware.at("thesis");
  text += "\n**Figure 73**: hardware, clocks of the simulated RTL and ms at 100 MHz\n\n" +
          header({"design", "size", "pixels per clock", "angles", "passes", "Canny",
                  "to the last line", "after the last pixel", "at most, and lines that wait",
                  "frame to frame", "Canny ms", "Hough ms more", "all ms"});
  text +=
      row({"thesis", cell(thesis, "size"), "1", "12", "0", "-", cell(thesis, "clocks"), "-", "-",
           "-", cell(thesis, "canny_ms"), cell(thesis, "hough_ms"), cell(thesis, "total_ms")});
  for (const Json& times : hardware.at("ours"))
    text += row(
        {"here", cell(times, "size"), cell(times, "pixels_per_clock"), cell(times, "angles"),
         cell(times, "hysteresis_passes"), cell(times, "canny_clocks"), cell(times, "clocks"),
         cell(times, "clocks_after_last_pixel"),
         cell(times, "clocks_after_last_pixel_at_most") + " + " + cell(times, "lines_that_wait"),
         cell(times, "sustained_clocks_per_frame"), cell(times, "canny_ms"),
         cell(times, "hough_ms_more"), cell(times, "total_ms")});
  return text;
}

}  // namespace colonnade
