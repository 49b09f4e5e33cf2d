// Boxes and tracks in MOTChallenge's format: frames, ids and pixels from 1.
#include <fmt/format.h>

#include "tools/sequence/objects.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

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

}  // namespace

const MakeWriter make_mot_writer = make_writer<MotWriter>;

}  // namespace lcs::sequence
