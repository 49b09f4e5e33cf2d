/// \file
/// All experiments on one camera, rover and IMU.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/kinematics/drift.h"
#include "tools/kinematics/imu_study.h"
#include "tools/kinematics/sweeps.h"
#include "tools/kinematics/timing.h"

namespace lcs::kinematics {

struct Study {
  StudyConfig config;
  std::vector<RotationRow> rotation;
  std::vector<TranslationRow> translation;
  std::vector<FoeRow> foe;
  std::vector<MountRow> mount;
  std::vector<FocalRow> focal;
  std::vector<DriveRow> drives;
  std::vector<ImuRow> imu;
  std::vector<BumpRow> bumps;
  std::vector<DriftRow> drift;
  LeftOut left_out;
};

/// Depths of the sweeps' geometric points, which cover the whole image.
PointSet study_points(const sim::Pinhole& camera);

/// Number of pieces of work in a study.
int study_pieces(const StudyConfig& config);

/// Deterministic: equal configurations give equal bits with any number of cores.
/// \param tick called from this thread with the number of pieces just done; its exceptions end the
///   study.
/// \throws input::Error, sim::PhysicsError, std::runtime_error
Study carry_out(const StudyConfig& config, const Tick& tick);

}  // namespace lcs::kinematics
