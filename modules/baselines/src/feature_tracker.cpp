// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "feature_tracker.hpp"

#include <mrpt/vision/tracking.h>

namespace colonnade {
namespace {

constexpr float kBorder_px = 10.0f;  ///< corners nearer to the border are dropped

template <class Features>
std::vector<TrackedFeature> follow(mrpt::vision::CFeatureTracker_KL& tracker,
                                   const mrpt::img::CImage& before, const mrpt::img::CImage& now,
                                   Features& features) {
  tracker.trackFeatures(before, now, features);
  const auto width = static_cast<float>(now.getWidth());
  const auto height = static_cast<float>(now.getHeight());
  std::vector<TrackedFeature> kept;
  for (auto feature = features.begin(); feature != features.end();) {
    const auto x = static_cast<float>(feature->pt.x);
    const auto y = static_cast<float>(feature->pt.y);
    const bool followed = feature->track_status == mrpt::vision::status_TRACKED ||
                          feature->track_status == mrpt::vision::status_IDLE;
    const bool inside =
        x >= kBorder_px && y >= kBorder_px && x <= width - kBorder_px && y <= height - kBorder_px;
    if (followed && inside) {
      kept.push_back(
          {static_cast<std::uint64_t>(feature->ID), Eigen::Vector2f(x, y).cast<double>()});
      ++feature;
    } else {
      feature = features.erase(feature);
    }
  }
  return kept;
}

}  // namespace

struct FeatureTracker::Impl {
  bool subpixel = false;
  mrpt::vision::CFeatureTracker_KL tracker;
  mrpt::vision::TKeyPointList whole;
  mrpt::vision::TKeyPointfList between;
  mrpt::img::CImage before;
};

FeatureTracker::FeatureTracker(const KinectSlamOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->subpixel = options.subpixel;
  auto& parameters = impl_->tracker.extra_params;
  parameters["add_new_features"] = 1;
  parameters["add_new_feat_min_separation"] = options.separation_px;
  parameters["add_new_feat_max_features"] = options.max_features;
  parameters["add_new_feat_patch_size"] = 21;
  parameters["minimum_KLT_response_to_add"] = options.response_to_add;
  parameters["check_KLT_response_every"] = options.check_every;
  parameters["minimum_KLT_response"] = options.response_to_keep;
  parameters["update_patches_every"] = 0;
  parameters["window_width"] = options.window_px;
  parameters["window_height"] = options.window_px;
}
FeatureTracker::~FeatureTracker() = default;

std::vector<TrackedFeature> FeatureTracker::track(const cv::Mat& gray) {
  const mrpt::img::CImage now(gray, mrpt::img::DEEP_COPY);
  // The first image is compared with itself: nothing to follow yet, but corners to add.
  const mrpt::img::CImage& before = impl_->before.isEmpty() ? now : impl_->before;
  auto features = impl_->subpixel ? follow(impl_->tracker, before, now, impl_->between)
                                  : follow(impl_->tracker, before, now, impl_->whole);
  impl_->before = now;
  return features;
}

}  // namespace colonnade
