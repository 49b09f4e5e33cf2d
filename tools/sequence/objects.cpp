#include "tools/sequence/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lcs::sequence {
namespace {

constexpr int kMotPedestrian = 1, kMotCar = 3, kMotDistractor = 8;

std::string category_of(const scenario::Scenario& scenario, const sim::Object& object) {
  const auto actor = std::find_if(scenario.actors.begin(), scenario.actors.end(),
                                  [&](const scenario::Actor& a) { return a.name == object.name; });
  if (actor == scenario.actors.end() || actor->body) return "object";
  switch (actor->shape) {
    case scenario::Shape::box:
      return "box";
    case scenario::Shape::cylinder:
      return "cylinder";
    case scenario::Shape::pedestrian:
      return "pedestrian";
    case scenario::Shape::car:
      return "car";
    case scenario::Shape::own:
      break;
  }
  return "object";
}

}  // namespace

cv::Mat1b object_mask(const sim::FrameTruth& truth) {
  cv::Mat1b mask(truth.object.size());
  for (int y = 0; y < mask.rows; ++y) {
    const int* object = truth.object[y];
    const float* depth = truth.depth_m[y];
    unsigned char* to = mask[y];
    for (int x = 0; x < mask.cols; ++x) {
      if (object[x] > kMostObjects) {
        throw std::out_of_range(
            fmt::format("a mask has room for {} objects, and this scene has more", kMostObjects));
      }
      const bool is_rover = object[x] < 0 && !std::isinf(depth[x]);
      to[x] = is_rover ? kVoid : static_cast<unsigned char>(std::max(object[x], 0));
    }
  }
  return mask;
}

ObjectKind kind_of(const scenario::Scenario& scenario, const sim::Object& object) {
  ObjectKind kind;
  kind.category = category_of(scenario, object);
  const auto* place = std::find(std::begin(kCategories), std::end(kCategories), kind.category);
  kind.coco = static_cast<int>(place - std::begin(kCategories)) + 1;
  kind.mot = kind.category == "pedestrian" ? kMotPedestrian
             : kind.category == "car"      ? kMotCar
                                           : kMotDistractor;
  kind.moves = std::any_of(scenario.actors.begin(), scenario.actors.end(),
                           [&](const scenario::Actor& actor) {
                             const std::string& body = actor.body ? *actor.body : actor.name;
                             return (actor.name == object.name || body == object.name) &&
                                    !std::holds_alternative<scenario::Still>(actor.trajectory);
                           });
  return kind;
}

}  // namespace lcs::sequence
