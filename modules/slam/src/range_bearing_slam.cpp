// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/range_bearing_slam.hpp"

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <ostream>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/config.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/frames/action_motion.hpp"
#include "colonnade/frames/mrclam_import.hpp"
#include "colonnade/frames/range_bearing_observation.hpp"

namespace colonnade {
namespace {

using Source = mrpt::config::CConfigFileBase;

/// A word of the file as one of our enumerators.
template <class Enum>
void readWord(const Source& source, const std::string& section, const char* key, Enum& value,
              const std::vector<std::string>& names) {
  const std::string word = trimmed(source.read_string(section, key, names[value]));
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end())
    throw Error("[" + section + "] " + key + " = " + word + ": expected " + joined(names, ", "),
                ExitCode::kUsage);
  value = static_cast<Enum>(found - names.begin());
}

const std::vector<std::string> kMethods{"assocNN", "assocJCBB", "assocHypotheses"};
const std::vector<std::string> kMetrics{"metricMaha", "metricML"};

RangeBearingOptions effective(const RangeBearingSlam::TOptions& options) {
  RangeBearingOptions o = options.extra;
  o.range_sigma_m = options.std_sensor_range;
  o.bearing_sigma = options.std_sensor_yaw;
  o.association = options.data_assoc_method == RangeBearingSlam::assocNN     ? "nn"
                  : options.data_assoc_method == RangeBearingSlam::assocJCBB ? "jcbb"
                                                                             : "hypotheses";
  o.metric = options.data_assoc_metric == RangeBearingSlam::metricML ? "likelihood" : "mahalanobis";
  o.gate_probability = options.data_assoc_IC_chi2_thres;
  o.world_with_map = false;
  return o;
}

/// The motion MRPT's filter would use. Without a stated covariance that of wheel odometry.
MotionIncrement incrementOf(const mrpt::obs::CActionCollection* actions,
                            const RangeBearingSlam::TOptions& options) {
  MotionIncrement increment;
  const auto motion = actions && !options.force_ignore_odometry ? motionOf(*actions) : std::nullopt;
  if (!motion) {
    for (int i = 0; i < 3; ++i) {
      const double sigma = options.stds_Q_no_odo[static_cast<std::size_t>(i)];
      increment.covariance(i, i) = sigma * sigma;
    }
    return increment;
  }
  increment.source = MotionSource::kOdometry;
  increment.T_previous_robot = motion->T_before_after;
  if (motion->covariance) {
    increment.covariance = *motion->covariance;
  } else {
    ArcSum arc{WheelSpeedNoise{}};
    arc.add(motion->T_before_after.translation().norm(), motion->T_before_after.phi, 1.0);
    increment.covariance = arc.covariance();
  }
  return increment;
}

/// The outline `quantiles` sigmas around a place. (CEllipsoid2D would do it by itself, but is made
/// at addresses its class is not aligned to.)
mrpt::opengl::CSetOfLines::Ptr ellipse(const Eigen::Matrix2d& covariance, double quantiles,
                                       const std::string& name, const Eigen::Vector2d& p_world) {
  constexpr int kSides = 48;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Eigen::Matrix2d axes = quantiles * solver.eigenvectors() *
                               solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  auto outline = mrpt::opengl::CSetOfLines::Create();
  Eigen::Vector2d from = axes.col(0);
  for (int i = 1; i <= kSides; ++i) {
    const double t = 2.0 * kPi * i / kSides;
    const Eigen::Vector2d to = axes * Eigen::Vector2d(std::cos(t), std::sin(t));
    outline->appendLine(from.x(), from.y(), 0.0, to.x(), to.y(), 0.0);
    from = to;
  }
  outline->setLocation(p_world.x(), p_world.y(), 0.0);
  outline->setName(name);
  outline->enableShowName();
  return outline;
}

}  // namespace

void RangeBearingSlam::TOptions::loadFromConfigFile(const Source& source,
                                                    const std::string& section) {
  std::vector<double> Q(stds_Q_no_odo.begin(), stds_Q_no_odo.end());
  Q[2] = degrees(Q[2]);
  source.read_vector(section, "stds_Q_no_odo", Q, Q);
  if (Q.size() != 3)
    throw Error("[" + section + "] stds_Q_no_odo: expected three numbers x y phi_deg",
                ExitCode::kUsage);
  stds_Q_no_odo = {Q[0], Q[1], radians(Q[2])};
  std_sensor_range = source.read_double(section, "std_sensor_range", std_sensor_range);
  std_sensor_yaw =
      radians(source.read_double(section, "std_sensor_yaw_deg", degrees(std_sensor_yaw)));
  quantiles_3D_representation =
      source.read_double(section, "quantiles_3D_representation", quantiles_3D_representation);
  readWord(source, section, "data_assoc_method", data_assoc_method, kMethods);
  readWord(source, section, "data_assoc_metric", data_assoc_metric, kMetrics);
  data_assoc_IC_chi2_thres =
      source.read_double(section, "data_assoc_IC_chi2_thres", data_assoc_IC_chi2_thres);
  force_ignore_odometry = source.read_bool(section, "force_ignore_odometry", force_ignore_odometry);
  filter.invariant = source.read_bool(section, "invariant", filter.invariant);
  extra.use_ids = source.read_bool(section, "use_ids", extra.use_ids);
  extra.bearing_only = source.read_bool(section, "bearing_only", extra.bearing_only);
  if (!(std_sensor_range > 0.0 && std_sensor_yaw > 0.0))
    throw Error("[" + section + "] std_sensor_range and std_sensor_yaw_deg must be positive",
                ExitCode::kUsage);
}

void RangeBearingSlam::TOptions::dumpToTextStream(std::ostream& out) const {
  ConfigWriter writer;
  writer.add(filter);
  writer.add(effective(*this));
  out << "std_sensor_range = " << formatDouble(std_sensor_range)
      << "\nstd_sensor_yaw_deg = " << formatDouble(degrees(std_sensor_yaw))
      << "\ndata_assoc_method = " << kMethods[data_assoc_method]
      << "\ndata_assoc_metric = " << kMetrics[data_assoc_metric]
      << "\ndata_assoc_IC_chi2_thres = " << formatDouble(data_assoc_IC_chi2_thres) << "\n"
      << writer.text();
}

RangeBearingSlam::RangeBearingSlam() { reset(); }
RangeBearingSlam::~RangeBearingSlam() = default;

void RangeBearingSlam::loadOptions(const Source& ini) {
  options.loadFromConfigFile(ini, "RangeBearingKFSLAM");
  reset();
}

void RangeBearingSlam::reset() {
  estimator_ = std::make_unique<RangeBearingEstimator>(effective(options), options.filter);
  last_ = {};
  steps_ = 0.0;
}

void RangeBearingSlam::saveMap(const std::filesystem::path& file) const {
  writeFileAtomically(file, MapFile::text(estimator_->savedMap()));
}

void RangeBearingSlam::loadMap(const std::filesystem::path& file, bool localize) {
  Resumption from{{}, MapFile::read(file)};
  from.localize = localize;
  from.T_world_robot = from.map.T_world_start;
  resume(from);
}

void RangeBearingSlam::loadMap(const std::filesystem::path& file, const MapStart& start) {
  resume({start, MapFile::read(file)});
}

void RangeBearingSlam::resume(const Resumption& from) {
  auto estimator =
      std::make_unique<RangeBearingEstimator>(effective(options), options.filter, from);
  reset();
  estimator_ = std::move(estimator);
}

void RangeBearingSlam::processActionObservation(
    const std::shared_ptr<mrpt::obs::CActionCollection>& action,
    const std::shared_ptr<mrpt::obs::CSensoryFrame>& SF) {
  const auto observation =
      SF ? SF->getObservationByClass<mrpt::obs::CObservationBearingRange>() : nullptr;
  if (!observation) throw Error("the sensory frame holds no CObservationBearingRange");
  // Stamps tell how alike errors are; logs without a clock count steps.
  steps_ += 1.0;
  const double stamp_s = mrpt::Clock::toDouble(observation->timestamp);
  last_ = estimator_->step(stamp_s > 0.0 ? stamp_s : steps_, incrementOf(action.get(), options),
                           rangeBearingOf(*observation));
}

void RangeBearingSlam::getCurrentRobotPose(mrpt::poses::CPosePDFGaussian& out_robotPose) const {
  const Pose2 pose = estimator_->filter().pose();
  const Eigen::Matrix3d P = estimator_->filter().poseCovariance();
  out_robotPose.mean = mrpt::poses::CPose2D(pose.x, pose.y, pose.phi);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out_robotPose.cov(row, column) = P(row, column);
}

void RangeBearingSlam::getCurrentState(
    mrpt::poses::CPosePDFGaussian& out_robotPose,
    std::vector<mrpt::math::TPoint2D_<double>>& out_landmarksPositions,
    std::map<unsigned int, std::int64_t>& out_landmarkIDs,
    mrpt::math::CVectorDynamic<double>& out_fullState,
    mrpt::math::CMatrixDynamic<double>& out_fullCovariance) const {
  getCurrentRobotPose(out_robotPose);
  out_landmarksPositions.clear();
  out_landmarkIDs.clear();
  for (const LandmarkRecord& landmark : estimator_->filter().landmarkMap()) {
    const auto place = static_cast<unsigned int>(out_landmarksPositions.size());
    out_landmarksPositions.emplace_back(landmark.p_world.x(), landmark.p_world.y());
    out_landmarkIDs[place] =
        estimator_->identityOf(landmark.id).value_or(static_cast<int>(number(landmark.id)));
  }
  const State state = estimator_->filter().fullState();
  out_fullState.resize(static_cast<std::size_t>(state.x.size()));
  for (Eigen::Index i = 0; i < state.x.size(); ++i)
    out_fullState[static_cast<std::size_t>(i)] = state.x(i);
  out_fullCovariance.resize(state.P.rows(), state.P.cols());
  for (Eigen::Index row = 0; row < state.P.rows(); ++row)
    for (Eigen::Index column = 0; column < state.P.cols(); ++column)
      out_fullCovariance(row, column) = state.P(row, column);
}

void RangeBearingSlam::getAs3DObject(std::shared_ptr<mrpt::opengl::CSetOfObjects>& outObj) const {
  if (!outObj) outObj = mrpt::opengl::CSetOfObjects::Create();
  outObj->clear();
  const EkfSlam& filter = estimator_->filter();
  outObj->insert(ellipse(filter.poseCovariance().topLeftCorner<2, 2>(),
                         options.quantiles_3D_representation, "robot",
                         filter.pose().translation()));
  for (const LandmarkRecord& landmark : estimator_->filter().landmarkMap()) {
    const auto identity = estimator_->identityOf(landmark.id);
    outObj->insert(ellipse(landmark.covariance, options.quantiles_3D_representation,
                           identity ? "landmark " + std::to_string(*identity)
                                    : "landmark #" + std::to_string(number(landmark.id)),
                           landmark.p_world));
  }
}

}  // namespace colonnade
