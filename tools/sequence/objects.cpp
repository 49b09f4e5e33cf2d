#include "tools/sequence/objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace lcs::sequence {
namespace {

/// MOTChallenge's classes by their ids, from 1 (MOT16, table 4).
constexpr std::array<std::string_view, 12> kMotClasses{
    "pedestrian", "person on vehicle",      "car",           "bicycle",
    "motorbike",  "non motorized vehicle",  "static person", "distractor",
    "occluder",   "occluder on the ground", "occluder full", "reflection"};
constexpr int kMotDistractor = 8;

/// In the order of `scenario::Shape`.
constexpr std::array<const char*, 6> kCategories{"box", "cylinder",   "pedestrian",
                                                 "car", "pedestrian", "object"};
static_assert(kCategories.size() == static_cast<std::size_t>(scenario::Shape::own) + 1);

std::string category_of(const scenario::Actor& actor) {
  if (!actor.kind.empty()) return actor.kind;
  return actor.body ? "object" : kCategories[static_cast<std::size_t>(actor.shape)];
}

/// Place in a list, from 1; 0 for none.
template <class List>
int place_of(const std::string& name, const List& list) {
  const auto found = std::find(list.begin(), list.end(), name);
  return found == list.end() ? 0 : static_cast<int>(found - list.begin()) + 1;
}

}  // namespace

std::vector<std::string> categories_of(const scenario::Scenario& scenario) {
  std::vector<std::string> all{"pedestrian", "car", "box", "cylinder", "object"};
  for (const scenario::Actor& actor : scenario.actors) {
    if (place_of(category_of(actor), all) == 0) all.push_back(category_of(actor));
  }
  return all;
}

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
  ObjectKind kind{.category = "object"};
  for (const scenario::Actor& actor : scenario.actors) {
    if (actor.body.value_or(actor.name) != object.name) continue;
    kind.category = category_of(actor);
    kind.moves = !actor.stands();
  }
  kind.coco = place_of(kind.category, categories_of(scenario));
  kind.mot = place_of(kind.category, kMotClasses);
  if (kind.mot == 0) kind.mot = kMotDistractor;
  return kind;
}

}  // namespace lcs::sequence
