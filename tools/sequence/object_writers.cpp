// Boxes, tracks and masks of objects: MOTChallenge, COCO and DAVIS.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/files/json_node.h"
#include "tools/sequence/objects.h"
#include "tools/sequence/png.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

/// Boxes and tracks in MOTChallenge's format: frames, ids and pixels from 1.
class MotWriter : public Writer {
 public:
  explicit MotWriter(const SequenceInfo& info)
      : Writer(info), folder_(fmt::format("mot/{}", info.scenario.name)) {}

  void write(const FrameView& frame, FrameOutput& output) const override {
    const int number = frame.now.index + 1;
    output.files.push_back({fmt::format("{}/img1/{:06}.png", folder_, number), "",
                            picture_path(frame.stamp_ns, info_.place)});
    std::string& rows = output.rows["mot"];
    for (const sim::ObjectTruth& object : frame.now.objects) {
      const ObjectKind kind =
          kind_of(info_.scenario, info_.objects.at(static_cast<std::size_t>(object.object - 1)));
      rows += fmt::format("{},{},{},{},{},{},{},{},{}\n", number, object.object, object.left + 1,
                          object.top + 1, object.right - object.left, object.bottom - object.top,
                          kind.moves ? 1 : 0, kind.mot, object.visible_fraction);
    }
  }

  std::vector<SequenceDocument> documents() const override {
    const sim::Pinhole& camera = info_.calibration.camera;
    const std::string info = fmt::format(
        "[Sequence]\nname={}\nimDir=img1\nframeRate={}\nseqLength={}\nimWidth={}\nimHeight={}\n"
        "imExt=.png\n",
        info_.scenario.name, info_.scenario.camera.rate_hz, info_.scenario.frames, camera.width_px,
        camera.height_px);
    return {{folder_ + "/seqinfo.ini", {{.text = info}}},
            {folder_ + "/gt/gt.txt", {{.stream = "mot"}}}};
  }

 private:
  std::string folder_;
};

/// Boxes and masks in COCO's format: one JSON file, ids from 1, pixels from 0.
class CocoWriter : public Writer {
 public:
  using Writer::Writer;

  void write(const FrameView& frame, FrameOutput& output) const override {
    const sim::Pinhole& camera = info_.calibration.camera;
    const int image = frame.now.index + 1;
    output.rows["coco_images"] =
        fmt::format(R"({{"id":{},"file_name":"{}","width":{},"height":{}}})", image,
                    picture_path(frame.stamp_ns, info_.place), camera.width_px, camera.height_px);
    const int count = static_cast<int>(info_.objects.size());
    const cv::Rect picture(0, 0, camera.width_px, camera.height_px);
    std::string& rows = output.rows["coco_annotations"];
    for (const sim::ObjectTruth& object : frame.now.objects) {
      const auto id = static_cast<std::size_t>(object.object);
      rows += fmt::format(
          R"({}{{"id":{},"image_id":{},"category_id":{},"bbox":[{},{},{},{}],"area":{},"iscrowd":0,)"
          R"("track_id":{},"segmentation":{{"size":[{},{}],"counts":[{}]}}}})",
          rows.empty() ? "" : ",\n", frame.now.index * count + object.object, image,
          kind_of(info_.scenario, info_.objects.at(id - 1)).coco, object.left, object.top,
          object.right - object.left, object.bottom - object.top, object.visible_px, object.object,
          camera.height_px, camera.width_px,
          fmt::join(sim::runs_in(picture, sim::mask_of(object)), ","));
    }
  }

  std::vector<SequenceDocument> documents() const override {
    nlohmann::json categories = nlohmann::json::array();
    for (const std::string& name : categories_of(info_.scenario)) {
      categories.push_back({{"id", categories.size() + 1}, {"name", name}});
    }
    const nlohmann::json info = {{"description", info_.scenario.name}};
    return {{"coco/annotations.json",
             {{.text = fmt::format(R"({{"info":{},"licenses":[],"categories":{},"images":[)",
                                   files::json_text(info), files::json_text(categories))},
              {.stream = "coco_images", .separator = ",\n"},
              {.text = R"(],"annotations":[)"},
              {.stream = "coco_annotations", .separator = ",\n"},
              {.text = "]}\n"}}}};
  }
};

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

/// Masks in DAVIS's format: indexed PNG.
class DavisWriter : public Writer {
 public:
  explicit DavisWriter(const SequenceInfo& info) : Writer(info) {
    const std::size_t objects = info.objects.size();
    if (objects <= kMostObjects) return;
    throw input::Error({info.scenario.scene.string(), 0},
                       "the scene has {} objects, and a DAVIS mask of 8 bits has room for {}; "
                       "leave davis out of --formats, or take the names of some bodies away",
                       objects, kMostObjects);
  }

  void write(const FrameView& frame, FrameOutput& output) const override {
    cv::Mat1b mask;
    frame.mask.convertTo(mask, CV_8U);
    mask.setTo(kDavisVoid, frame.mask == kVoid);
    output.files.push_back(
        {fmt::format("davis/Annotations/480p/{}/{:05}.png", info_.scenario.name, frame.now.index),
         encode_png(mask, palette_), ""});
  }

 private:
  std::vector<Rgb> palette_ = palette();
};

}  // namespace

const MakeWriter make_mot_writer = make_writer<MotWriter>;
const MakeWriter make_coco_writer = make_writer<CocoWriter>;
const MakeWriter make_davis_writer = make_writer<DavisWriter>;

}  // namespace lcs::sequence
