// Boxes, tracks and masks of objects: MOTChallenge, COCO and DAVIS.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "tools/files/json_node.h"
#include "tools/sequence/png.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

// Pixel values of a mask: 0 is the static scene and the sky, then the objects, then the rover.
constexpr std::size_t kMostObjects = 253;
constexpr unsigned char kDavisVoid = 254;

/// The palette of DAVIS and Pascal VOC: each three bits of an index set the next lower bits of the
/// three colours, from the highest on.
std::vector<Rgb> palette() {
  std::vector<Rgb> colours(256);
  for (unsigned int index = 0; index < colours.size(); ++index) {
    for (unsigned int bit = 0; bit < 8; ++bit) {
      const auto colour = bit % 3;
      const unsigned int set = index >> bit & 1;
      colours[index][colour] =
          static_cast<std::uint8_t>(colours[index][colour] | set << (7 - bit / 3));
    }
  }
  return colours;
}

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

/// Boxes and tracks in MOTChallenge's format: frames, ids and pixels from 1.
Writer mot_writer(const SequenceInfo& info) {
  const std::string folder = fmt::format("mot/{}", info.scenario.name);
  const sim::Pinhole& camera = info.calibration.camera;
  const std::string about = fmt::format(
      "[Sequence]\nname={}\nimDir=img1\nframeRate={}\nseqLength={}\nimWidth={}\nimHeight={}\n"
      "imExt=.png\n",
      info.scenario.name, info.scenario.camera.rate_hz, info.scenario.frames, camera.width_px,
      camera.height_px);
  const auto write = [info, folder](const FrameView& frame, FrameOutput& output) {
    const int number = frame.now.index + 1;
    output.files.push_back({fmt::format("{}/img1/{:06}.png", folder, number), "",
                            picture_path(frame.stamp_ns, info.place)});
    std::string& rows = output.rows["mot"];
    for (const sim::ObjectTruth& object : frame.now.objects) {
      const ObjectKind kind =
          kind_of(info.scenario, info.objects.at(static_cast<std::size_t>(object.object - 1)));
      rows += fmt::format("{},{},{},{},{},{},{},{},{}\n", number, object.object, object.left + 1,
                          object.top + 1, object.right - object.left, object.bottom - object.top,
                          kind.moves ? 1 : 0, kind.mot, object.visible_fraction);
    }
  };
  return {
      write,
      {{folder + "/seqinfo.ini", {{.text = about}}}, {folder + "/gt/gt.txt", {{.stream = "mot"}}}}};
}

/// Boxes and masks in COCO's format: one JSON file, ids from 1, pixels from 0.
Writer coco_writer(const SequenceInfo& info) {
  const auto write = [info](const FrameView& frame, FrameOutput& output) {
    const sim::Pinhole& camera = info.calibration.camera;
    const int image = frame.now.index + 1;
    output.rows["coco_images"] =
        fmt::format(R"({{"id":{},"file_name":"{}","width":{},"height":{}}})", image,
                    picture_path(frame.stamp_ns, info.place), camera.width_px, camera.height_px);
    const int count = static_cast<int>(info.objects.size());
    const cv::Rect picture(0, 0, camera.width_px, camera.height_px);
    std::string& rows = output.rows["coco_annotations"];
    for (const sim::ObjectTruth& object : frame.now.objects) {
      const auto id = static_cast<std::size_t>(object.object);
      rows += fmt::format(
          R"({}{{"id":{},"image_id":{},"category_id":{},"bbox":[{},{},{},{}],"area":{},"iscrowd":0,)"
          R"("track_id":{},"segmentation":{{"size":[{},{}],"counts":[{}]}}}})",
          rows.empty() ? "" : ",\n", frame.now.index * count + object.object, image,
          kind_of(info.scenario, info.objects.at(id - 1)).coco, object.left, object.top,
          object.right - object.left, object.bottom - object.top, object.visible_px, object.object,
          camera.height_px, camera.width_px,
          fmt::join(sim::runs_in(picture, sim::mask_of(object)), ","));
    }
  };
  nlohmann::json categories = nlohmann::json::array();
  for (const std::string& name : categories_of(info.scenario)) {
    categories.push_back({{"id", categories.size() + 1}, {"name", name}});
  }
  const nlohmann::json about = {{"description", info.scenario.name}};
  return {write,
          {{"coco/annotations.json",
            {{.text = fmt::format(R"({{"info":{},"licenses":[],"categories":{},"images":[)",
                                  files::json_text(about), files::json_text(categories))},
             {.stream = "coco_images", .separator = ",\n"},
             {.text = R"(],"annotations":[)"},
             {.stream = "coco_annotations", .separator = ",\n"},
             {.text = "]}\n"}}}}};
}

/// Masks in DAVIS's format: indexed PNG.
Writer davis_writer(const SequenceInfo& info) {
  const std::size_t objects = info.objects.size();
  if (objects > kMostObjects) {
    throw input::Error({info.scenario.scene.string(), 0},
                       "the scene has {} objects, and a DAVIS mask of 8 bits has room for {}; "
                       "leave davis out of --formats, or take the names of some bodies away",
                       objects, kMostObjects);
  }
  return {[info, colours = palette()](const FrameView& frame, FrameOutput& output) {
    cv::Mat1b mask;
    frame.mask.convertTo(mask, CV_8U);
    mask.setTo(kDavisVoid, frame.mask == kVoid);
    output.files.push_back(
        {fmt::format("davis/Annotations/480p/{}/{:05}.png", info.scenario.name, frame.now.index),
         encode_png(mask, colours), ""});
  }};
}

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
