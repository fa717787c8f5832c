// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "object_bodies.hpp"

#include <cstdlib>
#include <map>

#include "jpeg_size.hpp"
#include "object_walker.hpp"

namespace colonnade {
namespace {

void knowIf(bool known) {
  if (!known) throw UnknownFormat();
}

}  // namespace

/// What stands between header and end flag of each class.
struct Bodies {
  static void matrix(ObjectWalker& w, std::size_t bytes_each) {
    const auto rows = w.bytes_.take<std::uint32_t>(), columns = w.bytes_.take<std::uint32_t>();
    if (rows > 100000 || columns > 100000) throw BadBytes("a matrix of absurd size");
    w.block(rows * columns, bytes_each);
  }

  static void pose2(ObjectWalker& w, std::uint8_t version) {
    knowIf(version <= 1);
    w.bytes_.skip(version == 0 ? 12 : 24);
  }

  static void pose3(ObjectWalker& w, std::uint8_t version) {
    if (version < 2) {
      w.object("");  // a matrix
      return;
    }
    knowIf(version <= 3);
    w.bytes_.skip(version == 2 ? 7 * 8 : 12 * 8);
  }

  static void camera(ObjectWalker& w, std::uint8_t version) {
    knowIf(version >= 1 && version <= 6);
    w.bytes_.skip(8 + (version >= 3 ? 8 : 5) * 8);
    if (version < 4)
      w.object("");
    else
      w.bytes_.skip(4 * 8);
    if (version >= 2) w.bytes_.skip(8);
    if (version >= 5) w.text();
    if (version >= 6) w.bytes_.skip(1);
  }

  static void image(ObjectWalker& w, std::uint8_t version) {
    knowIf(version >= 7 && version <= 9);
    if (w.flag()) {  // stored in a file of its own
      w.text();
      return;
    }
    const bool colour = w.flag();
    const auto width = w.bytes_.take<std::int32_t>(), height = w.bytes_.take<std::int32_t>();
    if (std::abs(static_cast<std::int64_t>(width)) * std::abs(static_cast<std::int64_t>(height)) >
            ObjectWalker::kMostPixels ||
        (width < 0) != (height < 0))
      throw BadBytes("an image of absurd size");
    if (!colour) return grayBody(w, version, width, height);
    if (width < 0) {
      w.block(static_cast<std::uint32_t>(width * height), 3);
    } else if (width > 0 && height > 0) {
      const auto size = w.count(1);
      const auto jpeg = jpegSize(w.bytes_.takeBlock(size), size);
      if (!jpeg ||
          static_cast<std::int64_t>(jpeg->width) * jpeg->height > ObjectWalker::kMostPixels)
        throw BadBytes("an image that is no JPEG of sound size");
    }
  }

  static void grayBody(ObjectWalker& w, std::uint8_t version, std::int32_t width,
                       std::int32_t height) {
    w.bytes_.skip(4);  // origin
    const auto size = w.bytes_.take<std::uint32_t>();
    const std::int32_t depth = version >= 9 ? w.bytes_.take<std::int32_t>() : 0;
    if (w.flag()) throw BadBytes("a zipped gray image, which MRPT 2 does not read");
    if (width < 0 || depth < 0 || depth > 6 || size > ObjectWalker::kLargestBlock ||
        size < static_cast<std::uint32_t>(width) * static_cast<std::uint32_t>(height))
      throw BadBytes("a gray image of absurd size");
    w.bytes_.skip(size);
  }

  static void rangeScan3(ObjectWalker& w, std::uint8_t version) {
    knowIf(version >= 4 && version <= 10);
    w.bytes_.skip(4);  // longest range
    w.object("CPose3D");
    if (w.flag()) {  // points
      const auto points = w.count(3 * 4 + 2 * 2);
      w.block(points, version >= 8 ? 3 * 4 + 2 * 2 : 3 * 4);
    }
    const bool range = w.flag();
    if (version >= 9) w.bytes_.skip(4);  // unit
    if (range) {
      if (version < 9)
        w.object("");
      else
        rangeImage(w);
    }
    if (w.flag()) w.object("CImage");  // intensity
    if (w.flag()) w.object("CImage");  // confidence
    w.object("TCamera");
    w.object("TCamera");
    w.object("CPose3D");
    w.bytes_.skip(4 + 8);  // standard error, stamp
    w.text();
    w.flag();
    w.text();
    w.flag();
    w.text();
    if (version >= 5) w.flag();
    if (version >= 6) w.bytes_.skip(1);
    if (version >= 7) knowIf(!w.flag());  // pixel labels
    if (version >= 10)
      for (int layers = w.bytes_.take<std::uint8_t>(); layers > 0; --layers) {
        w.text();
        rangeImage(w);
      }
  }

  static void rangeImage(ObjectWalker& w) {
    const auto rows = w.bytes_.take<std::uint32_t>(), columns = w.bytes_.take<std::uint32_t>();
    if (static_cast<std::uint64_t>(rows) * columns >
        static_cast<std::uint64_t>(ObjectWalker::kMostPixels))
      throw BadBytes("a range image of absurd size");
    w.block(rows * columns, 2);
  }

  static void observationImage(ObjectWalker& w, std::uint8_t version) {
    knowIf(version == 4);
    w.object("CPose3D");
    w.object("TCamera");
    w.object("CImage");
    w.bytes_.skip(8);
    w.text();
  }

  static void odometry(ObjectWalker& w, std::uint8_t version) {
    knowIf(version <= 2);
    w.object("CPose2D");
    w.text();
    w.bytes_.skip(8);
    if (version == 0) return;
    if (w.flag() || version < 2) w.bytes_.skip(2 * 4);  // encoders
    const bool velocities = w.flag();
    if (version < 2)
      w.bytes_.skip(2 * 4);
    else if (velocities)
      w.bytes_.skip(3 * 8);
  }

  static void bearingRange(ObjectWalker& w, std::uint8_t version) {
    knowIf(version == 2 || version == 3);
    w.bytes_.skip(version == 3 ? 16 : 12);
    w.object("CPose3D");
    w.bytes_.skip(8);
    const bool covariances = version == 3 && w.flag();
    if (version == 3 && !covariances) w.bytes_.skip(3 * 4);
    for (auto readings = w.count(16); readings > 0; --readings) {
      w.bytes_.skip(16);
      if (covariances) w.object("");
    }
    w.text();
  }

  static void rangeScan2(ObjectWalker& w, std::uint8_t version) {
    knowIf(version == 6 || version == 7);
    w.bytes_.skip(4 + 1 + 4);
    w.object("CPose3D");
    const auto beams = w.count(4);
    w.block(beams, 4 + 1);
    w.bytes_.skip(4 + 8 + 4);
    w.text();
    w.bytes_.skip(8);  // pitch step
    if (version >= 7 && w.flag()) w.block(beams, 4);
  }

  static void sensoryFrame(ObjectWalker& w, std::uint8_t version) {
    knowIf(version == 2);
    return objects(w, "CObservation");
  }
  static void actionCollection(ObjectWalker& w, std::uint8_t version) {
    knowIf(version == 0);
    return objects(w, "CAction");
  }
  static void objects(ObjectWalker& w, const std::string& base) {
    const auto count = w.bytes_.take<std::uint32_t>();
    if (count > ObjectWalker::kMostObjects) throw BadBytes("a list of absurd length");
    for (std::uint32_t i = 0; i < count; ++i) w.object(base);
  }

  static void movement2(ObjectWalker& w, std::uint8_t version) {
    knowIf(version >= 4 && version <= 7);
    if (w.bytes_.take<std::int32_t>() == 0) {  // odometry
      w.object("CPose2D");
      w.bytes_.skip(4 + 6 * 4);
      if (w.bytes_.take<std::uint32_t>() > ObjectWalker::kMostObjects)
        throw BadBytes("a motion of too many particles");
      w.bytes_.skip((version >= 5 ? 6 : 4) * 4);
    } else {
      w.object("CPosePDF");
    }
    const bool velocities = w.flag();
    if (version < 7)
      w.bytes_.skip(2 * 4);
    else if (velocities)
      w.bytes_.skip(3 * 8);
    if (w.flag() || version < 7) w.bytes_.skip(2 * 4);
    if (version >= 6) w.bytes_.skip(8);
  }

  static void pdfGaussian2(ObjectWalker& w, std::uint8_t version) {
    knowIf(version == 2);
    w.object("CPose2D");
    w.bytes_.skip(6 * 8);
  }
};

const ObjectBody* bodyOf(const std::string& short_name) {
  static const std::map<std::string, ObjectBody> kBodies{
      {"CMatrixF", [](auto& w, auto) { Bodies::matrix(w, 4); }},
      {"CMatrix", [](auto& w, auto) { Bodies::matrix(w, 4); }},
      {"CMatrixD", [](auto& w, auto) { Bodies::matrix(w, 8); }},
      {"CPose2D", Bodies::pose2},
      {"CPose3D", Bodies::pose3},
      {"TCamera", Bodies::camera},
      {"CImage", Bodies::image},
      {"CObservation3DRangeScan", Bodies::rangeScan3},
      {"CObservationImage", Bodies::observationImage},
      {"CObservationOdometry", Bodies::odometry},
      {"CObservationBearingRange", Bodies::bearingRange},
      {"CObservation2DRangeScan", Bodies::rangeScan2},
      {"CSensoryFrame", Bodies::sensoryFrame},
      {"CActionCollection", Bodies::actionCollection},
      {"CActionRobotMovement2D", Bodies::movement2},
      {"CPosePDFGaussian", Bodies::pdfGaussian2},
  };
  const auto found = kBodies.find(short_name);
  return found == kBodies.end() ? nullptr : &found->second;
}

}  // namespace colonnade
