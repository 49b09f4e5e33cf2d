// Masks in DAVIS's format: indexed PNG.
#include <fmt/format.h>

#include <vector>

#include "tools/sequence/objects.h"
#include "tools/sequence/png.h"
#include "tools/sequence/writers.h"

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

const MakeWriter make_davis_writer = make_writer<DavisWriter>;

}  // namespace lcs::sequence
