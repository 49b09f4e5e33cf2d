/// \file
/// Objects in the formats of data sets: a mask of ids, and the category of each object.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/truth/truth.h"

namespace lcs::sequence {

inline constexpr std::uint16_t kVoid = 65535;  ///< in a mask: the rover itself, not counted

/// Ids of objects by pixel; 0 is the static scene and the sky.
cv::Mat1w object_mask(const sim::FrameTruth& truth);

struct ObjectKind {
  std::string category;  ///< the actor's class, or its shape's class; object for all others
  int coco = 0;          ///< category_id
  int mot = 0;           ///< MOTChallenge's class; 8, distractor, for a category that it lacks
  bool moves = false;    ///< an actor with a motion
};

ObjectKind kind_of(const scenario::Scenario& scenario, const sim::Object& object);

/// The categories of a scenario by their ids, from 1: five that any scenario has, and the other
/// classes of its actors in their order.
std::vector<std::string> categories_of(const scenario::Scenario& scenario);

}  // namespace lcs::sequence
