/// \file
/// When does the kinematics model hold? Every experiment on one camera and rover, and the plain
/// answer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/kinematics/drift.h"
#include "tools/kinematics/field_picture.h"
#include "tools/kinematics/heat_map.h"
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
  std::vector<HeatMap> heat;
  FieldFrame field;
};

/// The geometric points of the sweeps: over the whole image, from 1 m to 16 m.
PointSet study_points(const sim::Pinhole& camera);

/// Pieces of work that a study tells of.
int study_pieces(const StudyConfig& config);

/// Deterministic: the same configuration gives the same bits, with any number of cores.
/// \param tick called from this thread with the number of pieces done since; what it throws ends
///   the study.
/// \throws scenario::Error, sim::PhysicsError, std::runtime_error
Study carry_out(const StudyConfig& config, const Tick& tick);

}  // namespace lcs::kinematics
