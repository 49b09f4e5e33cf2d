/// \file
/// All experiments on one camera, rover and IMU.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/kinematics/drift.h"
#include "tools/kinematics/imu_study.h"
#include "tools/kinematics/sweeps.h"

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
};

/// The geometric points of the sweeps: over the whole image, from 1 m to 16 m.
PointSet study_points(const sim::Pinhole& camera);

/// Number of pieces of work in a study.
int study_pieces(const StudyConfig& config);

/// Deterministic: the same configuration gives the same bits, with any number of cores.
/// \param tick called from this thread with the number of pieces just done; its exceptions end the
///   study.
/// \throws scenario::Error, sim::PhysicsError, std::runtime_error
Study carry_out(const StudyConfig& config, const Tick& tick);

}  // namespace lcs::kinematics
