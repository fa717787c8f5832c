// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "colonnade/slam/range_bearing_estimator.hpp"

namespace mrpt::math {
template <typename T>
struct TPoint2D_;
template <class T>
class CVectorDynamic;
template <class T>
class CMatrixDynamic;
}  // namespace mrpt::math
namespace mrpt::obs {
class CActionCollection;
class CSensoryFrame;
}  // namespace mrpt::obs
namespace mrpt::opengl {
class CSetOfObjects;
}
namespace mrpt::poses {
class CPosePDFGaussian;
}

namespace colonnade {

/// The face of mrpt::slam::CRangeBearingKFSLAM2D on Colonnade's filter: programs written for it
/// only change the name of the class. Reads kf-slam's INI section; keys kf-slam does not know are
/// those of RangeBearingOptions, under `extra`.
class RangeBearingSlam {
 public:
  /// Names as in mrpt/slam/data_association.h; assocHypotheses is ours.
  enum TDataAssociationMethod { assocNN = 0, assocJCBB, assocHypotheses };
  enum TDataAssociationMetric { metricMaha = 0, metricML };

  struct TOptions : public mrpt::config::CLoadableOptions {
    /// Motion of one step without odometry: metres, metres, radians (degrees in the file).
    std::array<double, 3> stds_Q_no_odo{0.1, 0.1, radians(4.0)};
    double std_sensor_range = 0.1;             ///< metres
    double std_sensor_yaw = radians(0.5);      ///< radians (std_sensor_yaw_deg in the file)
    double quantiles_3D_representation = 3.0;  ///< sigmas drawn by getAs3DObject
    TDataAssociationMethod data_assoc_method = assocNN;
    TDataAssociationMetric data_assoc_metric = metricMaha;
    double data_assoc_IC_chi2_thres = 0.99;  ///< gate of a single reading without identity
    bool force_ignore_odometry = false;
    FilterOptions filter;       ///< invariant or plain EKF
    RangeBearingOptions extra;  ///< what kf-slam has no key for; the fields above win

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;
  };
  TOptions options;

  /// Section [RangeBearingKFSLAM], as kf-slam has it. Starts anew.
  void loadOptions(const mrpt::config::CConfigFileBase& ini);

  RangeBearingSlam();
  ~RangeBearingSlam();

  /// Forgets everything; takes `options` as they are now.
  void reset();

  /// Writes what a later run needs to go on: landmarks, their joint covariance and identities.
  /// Throws Error.
  void saveMap(const std::filesystem::path& file) const;
  /// reset(), in a map written by saveMap() or `colonnade run`: where the drive that made it
  /// started, or where `start` says. localize: the map stays as it is. Throws Error naming the file
  /// and what is wrong with it, and changes nothing then.
  void loadMap(const std::filesystem::path& file, bool localize = false);
  void loadMap(const std::filesystem::path& file, const MapStart& start);

  /// One step: the best motion of the actions (none: standing still with stds_Q_no_odo), then the
  /// CObservationBearingRange of the frame. Throws Error when the frame holds none.
  void processActionObservation(const std::shared_ptr<mrpt::obs::CActionCollection>& action,
                                const std::shared_ptr<mrpt::obs::CSensoryFrame>& SF);

  void getCurrentRobotPose(mrpt::poses::CPosePDFGaussian& out_robotPose) const;
  /// Landmarks in the order of their birth, those without a place yet left out of the positions;
  /// identities by position. The full state is (x, y, phi, blocks), also of landmarks without a
  /// place and of poses that wait for a second bearing.
  void getCurrentState(mrpt::poses::CPosePDFGaussian& out_robotPose,
                       std::vector<mrpt::math::TPoint2D_<double>>& out_landmarksPositions,
                       std::map<unsigned int, std::int64_t>& out_landmarkIDs,
                       mrpt::math::CVectorDynamic<double>& out_fullState,
                       mrpt::math::CMatrixDynamic<double>& out_fullCovariance) const;
  /// Ellipses of the robot and of every landmark, named.
  void getAs3DObject(std::shared_ptr<mrpt::opengl::CSetOfObjects>& outObj) const;

  const RangeBearingEstimator& estimator() const { return *estimator_; }
  const RangeBearingReport& getLastDataAssociation() const { return last_; }

 private:
  void resume(const Resumption& from);

  std::unique_ptr<RangeBearingEstimator> estimator_;
  RangeBearingReport last_;
  double steps_ = 0.0;
};

}  // namespace colonnade
