#include "tools/sequence/objects.h"

#include <algorithm>
#include <cmath>

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

cv::Mat1w object_mask(const sim::FrameTruth& truth) {
  cv::Mat1w mask(truth.object.size());
  std::transform(truth.object.begin(), truth.object.end(), truth.depth_m.begin(), mask.begin(),
                 [](int object, float depth_m) {
                   const bool is_rover = object < 0 && !std::isinf(depth_m);
                   return is_rover ? kVoid : static_cast<std::uint16_t>(std::max(object, 0));
                 });
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
