// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_plot.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

const cv::Scalar kInk(60, 60, 60), kGrid(225, 225, 225);
constexpr int kZoom = 2;  ///< drawn larger and halved: smooth edges
constexpr int kLeft = 70, kRight = 20, kTop = 40, kBottom = 80;

struct Axis {
  double low = 0.0, high = 1.0, step = 0.1;
};

/// An interval that begins and ends at round numbers, with about six steps.
Axis roundAxis(double low, double high) {
  if (!(high > low)) high = low + 1.0;
  const double raw = (high - low) / 6.0;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= raw) step = factor * power;
  return {step * std::floor(low / step), step * std::ceil(high / step), step};
}

class Diagram {
 public:
  explicit Diagram(const LinePlot& plot) : plot_(plot) {
    double x0 = HUGE_VAL, x1 = -HUGE_VAL, y0 = HUGE_VAL, y1 = -HUGE_VAL;
    for (const PlotSeries& series : plot.series)
      for (const cv::Point2d& p : series.points) {
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
        y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
      }
    if (!plot.equal_axes) y0 = std::min(0.0, y0);
    x_ = roundAxis(x0, x1);
    y_ = roundAxis(y0, y1);
    width_ = 760;
    height_ = 420;
    if (plot.equal_axes)
      height_ = static_cast<int>(width_ * (y_.high - y_.low) / (x_.high - x_.low));
    image_ = cv::Mat((height_ + kTop + kBottom) * kZoom, (width_ + kLeft + kRight) * kZoom, CV_8UC3,
                     cv::Scalar::all(255));
  }

  cv::Mat drawn() {
    axes();
    for (const double mark : plot_.x_marks)
      for (double y = y_.low; y < y_.high; y += 0.02 * (y_.high - y_.low))
        line({mark, y}, {mark, y + 0.01 * (y_.high - y_.low)}, kInk, 1);
    int column = kLeft;
    for (const PlotSeries& series : plot_.series) {
      for (std::size_t i = 0; i < series.points.size(); ++i) {
        if (series.dots)
          cv::circle(image_, pixel(series.points[i]), 4 * kZoom, series.colour, cv::FILLED,
                     cv::LINE_AA);
        else if (i > 0)
          line(series.points[i - 1], series.points[i], series.colour, 2);
      }
      const cv::Point at(column * kZoom, (kTop + height_ + 62) * kZoom);
      cv::rectangle(image_, at, at + cv::Point(14, -8) * kZoom, series.colour, cv::FILLED);
      column += 20 + text(series.name, {column + 20, kTop + height_ + 64}, 0.45) + 24;
    }
    cv::Mat small;
    cv::resize(image_, small, {}, 1.0 / kZoom, 1.0 / kZoom, cv::INTER_AREA);
    return small;
  }

 private:
  cv::Point pixel(const cv::Point2d& p) const {
    return {static_cast<int>(
                std::lround(kZoom * (kLeft + width_ * (p.x - x_.low) / (x_.high - x_.low)))),
            static_cast<int>(
                std::lround(kZoom * (kTop + height_ * (y_.high - p.y) / (y_.high - y_.low))))};
  }
  void line(const cv::Point2d& a, const cv::Point2d& b, const cv::Scalar& colour, int thickness) {
    cv::line(image_, pixel(a), pixel(b), colour, thickness * kZoom, cv::LINE_AA);
  }
  int text(const std::string& words, const cv::Point& at, double size) {
    int base = 0;
    cv::putText(image_, words, at * kZoom, cv::FONT_HERSHEY_SIMPLEX, size * kZoom, kInk, kZoom,
                cv::LINE_AA);
    return cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, size * kZoom, kZoom, &base).width /
           kZoom;
  }
  void axes() {
    for (double x = x_.low; x < x_.high + 0.5 * x_.step; x += x_.step) {
      line({x, y_.low}, {x, y_.high}, kGrid, 1);
      text(formatDouble(std::round(x / x_.step) * x_.step, 6),
           pixel({x, y_.low}) / kZoom + cv::Point(-10, 18), 0.42);
    }
    for (double y = y_.low; y < y_.high + 0.5 * y_.step; y += y_.step) {
      line({x_.low, y}, {x_.high, y}, kGrid, 1);
      text(formatDouble(std::round(y / y_.step) * y_.step, 6),
           pixel({x_.low, y}) / kZoom + cv::Point(-52, 4), 0.42);
    }
    text(plot_.title, {kLeft, 18}, 0.55);
    text(plot_.y_name, {kLeft, 34}, 0.42);
    text(plot_.x_name, {kLeft + width_ / 2 - 30, kTop + height_ + 38}, 0.42);
  }

  const LinePlot& plot_;
  Axis x_, y_;
  int width_ = 0, height_ = 0;
  cv::Mat image_;
};

}  // namespace

cv::Mat draw(const LinePlot& plot) { return Diagram(plot).drawn(); }

void writePlot(const std::filesystem::path& path, const LinePlot& plot) {
  std::vector<unsigned char> png;
  cv::imencode(".png", draw(plot), png);
  writeFileAtomically(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace colonnade
