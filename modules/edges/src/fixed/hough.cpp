// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hough.hpp"

#include <algorithm>
#include <cmath>

#include "row_kernels.hpp"

namespace colonnade {

int rhoReach(int width_px, int height_px) {
  const int x = width_px / 2;
  const int y = height_px / 2;
  int reach =
      0;  // the least whole number not below the distance of a corner, plus one for rounding
  while (reach * reach < x * x + y * y) ++reach;
  return reach + 1;
}

namespace fixed {
namespace {

constexpr int kRhoNeighbours = 2;       // bins on either side that compete with a bin
constexpr int kAngleNeighbours = 2;     // degrees
constexpr int kGuard = kRhoNeighbours;  // bins before and behind that stay zero

int classOf(int theta_deg, const FixedParameters& parameters) {
  return theta_deg >= parameters.vertical_from_deg && theta_deg <= parameters.vertical_to_deg ? 0
                                                                                              : 1;
}

/// Adds the votes of the pixels from `first` on, every other one to `others`: neighbouring pixels
/// often vote for the same bin, and would have to wait for each other.
void vote(const std::vector<Pixel>& pixels, std::size_t first, const AngleEntry& angle, int reach,
          unsigned short* bins, unsigned short* others) {
  constexpr std::size_t kBlock = 512;
  std::int32_t block[kBlock];
  const int offset = (reach << kAngleFraction) + (1 << (kAngleFraction - 1));
  for (std::size_t i = first; i < pixels.size(); i += kBlock) {
    const std::size_t count = std::min(kBlock, pixels.size() - i);
    rhoBins(pixels.data() + i, static_cast<int>(count), angle.cosine, angle.sine, offset, block);
    std::size_t k = 0;
    for (; k + 2 <= count; k += 2) {
      ++bins[block[k]];
      ++others[block[k + 1]];
    }
    if (k < count) ++bins[block[k]];
  }
}

/// A bin beats its neighbours: strictly those before it in (angle, rho), the others at least
/// equally. The two rows beside may be absent.
bool isPeak(const unsigned short* former, const unsigned short* here, const unsigned short* later,
            int bin) {
  const int votes = here[bin];
  for (int d = 1; d <= kRhoNeighbours; ++d) {
    if (here[bin - d] >= votes || here[bin + d] > votes) return false;
  }
  for (int d = -kRhoNeighbours; d <= kRhoNeighbours; ++d) {
    if (former && former[bin + d] >= votes) return false;
    if (later && later[bin + d] > votes) return false;
  }
  return true;
}

}  // namespace

std::vector<FixedLine> houghLines(const CannyResult& edges, const FixedShape& shape,
                                  const FixedParameters& parameters,
                                  std::vector<unsigned short>& votes) {
  const auto& angles = shape.angles_deg;
  const int reach = rhoReach(edges.edges.cols, edges.edges.rows);
  const auto stride = static_cast<std::size_t>(2 * reach + 1 + 2 * kGuard);
  votes.assign(angles.size() * stride, 0);
  const auto binsOf = [&](std::size_t a) { return votes.data() + a * stride + kGuard; };

  const int first_y = parameters.first_row - edges.edges.rows / 2;
  std::array<std::size_t, 4> first_inclined{};
  for (std::size_t d = 0; d < 4; ++d) {
    const auto& pixels = edges.of_direction[d];
    first_inclined[d] = static_cast<std::size_t>(
        std::lower_bound(pixels.begin(), pixels.end(), first_y,
                         [](const Pixel& pixel, int y) { return pixel.y < y; }) -
        pixels.begin());
  }
  const auto enabled = [&](std::size_t a) {
    return parameters.enabled.empty() || (a < parameters.enabled.size() && parameters.enabled[a]);
  };
  std::vector<unsigned short> others(stride);
  for (std::size_t a = 0; a < angles.size(); ++a) {
    if (!enabled(a)) continue;
    std::fill(others.begin(), others.end(), static_cast<unsigned short>(0));
    const auto& angle = kAngleTable[static_cast<std::size_t>(angles[a] - kFirstAngle_deg)];
    const bool inclined = classOf(angles[a], parameters) == 1;
    for (std::size_t d = 0; d < 4; ++d) {
      if (!(angle.admitted >> d & 1)) continue;
      vote(edges.of_direction[d], inclined ? first_inclined[d] : 0, angle, reach, binsOf(a),
           others.data());
    }
    addVotes(others.data(), 2 * reach + 1, binsOf(a));
  }

  std::vector<FixedLine> lines;
  for (std::size_t a = 0; a < angles.size(); ++a) {
    if (!enabled(a)) continue;
    const bool has_former = a > 0 && angles[a] - angles[a - 1] <= kAngleNeighbours;
    const bool has_later = a + 1 < angles.size() && angles[a + 1] - angles[a] <= kAngleNeighbours;
    const int line_class = classOf(angles[a], parameters);
    const int least = line_class == 0 ? parameters.vertical_votes : parameters.inclined_votes;
    const unsigned short* bins = binsOf(a);
    const int count = 2 * reach + 1;
    for (int bin = nextAtLeast(bins, 0, count, least); bin < count;
         bin = nextAtLeast(bins, bin + 1, count, least)) {
      if (!isPeak(has_former ? binsOf(a - 1) : nullptr, bins, has_later ? binsOf(a + 1) : nullptr,
                  bin)) {
        continue;
      }
      lines.push_back({angles[a], bin - reach, bins[bin], line_class});
    }
  }
  return lines;
}

}  // namespace fixed
}  // namespace colonnade
