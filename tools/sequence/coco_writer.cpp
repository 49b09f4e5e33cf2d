// Boxes and masks as COCO has them: one JSON file, ids from 1, pixels from 0.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "tools/sequence/objects.h"
#include "tools/sequence/run_lengths.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class CocoWriter : public Writer {
 public:
  explicit CocoWriter(const SequenceInfo& info) : info_(info) {}

  void write(const FrameView& frame, FrameOutput& output) const override {
    const sim::Pinhole& camera = info_.calibration.camera;
    const int image = frame.now.index + 1;
    output.rows["coco_images"] =
        fmt::format(R"({{"id":{},"file_name":"{}","width":{},"height":{}}})", image,
                    picture_path(frame.now.t_ns), camera.width_px, camera.height_px);
    const int count = static_cast<int>(info_.objects.size());
    const auto runs = run_lengths(frame.mask, count);
    std::string& rows = output.rows["coco_annotations"];
    for (const sim::ObjectTruth& object : frame.now.objects) {
      const auto id = static_cast<std::size_t>(object.object);
      rows += fmt::format(
          R"({}{{"id":{},"image_id":{},"category_id":{},"bbox":[{},{},{},{}],"area":{},"iscrowd":0,)"
          R"("track_id":{},"segmentation":{{"size":[{},{}],"counts":[{}]}}}})",
          rows.empty() ? "" : ",\n", frame.now.index * count + object.object, image,
          kind_of(info_.scenario, info_.objects.at(id - 1)).coco, object.left, object.top,
          object.right - object.left, object.bottom - object.top, object.visible_px, object.object,
          camera.height_px, camera.width_px, fmt::join(runs.at(id), ","));
    }
  }

  std::vector<Document> documents() const override {
    nlohmann::json categories = nlohmann::json::array();
    for (const char* name : kCategories) {
      categories.push_back({{"id", categories.size() + 1}, {"name", name}});
    }
    const nlohmann::json info = {{"description", info_.scenario.name}};
    return {{"coco/annotations.json",
             {{.text = fmt::format(R"({{"info":{},"licenses":[],"categories":{},"images":[)",
                                   info.dump(), categories.dump())},
              {.stream = "coco_images", .separator = ",\n"},
              {.text = R"(],"annotations":[)"},
              {.stream = "coco_annotations", .separator = ",\n"},
              {.text = "]}\n"}}}};
  }

 private:
  SequenceInfo info_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> run_lengths(const cv::Mat1b& mask, int count) {
  struct Runs {
    std::vector<std::uint32_t> lengths;
    std::uint32_t end = 0;  ///< of the last one
  };
  std::vector<Runs> all(static_cast<std::size_t>(count) + 1);
  cv::Mat1b columns;
  cv::transpose(mask, columns);
  const auto total = static_cast<std::uint32_t>(columns.total());
  const unsigned char* const pixels = columns[0];
  for (std::uint32_t begin = 0; begin < total;) {
    std::uint32_t end = begin + 1;
    while (end < total && pixels[end] == pixels[begin]) ++end;
    if (pixels[begin] <= count) {
      Runs& runs = all[pixels[begin]];
      runs.lengths.push_back(begin - runs.end);
      runs.lengths.push_back(end - begin);
      runs.end = end;
    }
    begin = end;
  }
  std::vector<std::vector<std::uint32_t>> lengths;
  for (Runs& runs : all) {
    if (runs.end < total) runs.lengths.push_back(total - runs.end);
    lengths.push_back(std::move(runs.lengths));
  }
  return lengths;
}

std::unique_ptr<Writer> make_coco_writer(const SequenceInfo& info) {
  return std::make_unique<CocoWriter>(info);
}

}  // namespace lcs::sequence
