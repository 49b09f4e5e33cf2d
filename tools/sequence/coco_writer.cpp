// Boxes and masks in COCO's format: one JSON file, ids from 1, pixels from 0.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "tools/files/json_node.h"
#include "tools/sequence/objects.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

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

}  // namespace

const MakeWriter make_coco_writer = make_writer<CocoWriter>;

}  // namespace lcs::sequence
