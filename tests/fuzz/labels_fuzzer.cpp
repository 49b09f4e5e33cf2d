// Labelled boxes in the formats of MOTChallenge, COCO or KITTI: read as valid boxes, or refused by
// an error that names the file.
#include <cmath>

#include "scenarios/scenario.h"
#include "tests/fuzz/input.h"
#include "tools/recording/labels.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lcs;
  const std::filesystem::path file = fuzz::work_folder() / "labels";
  fuzz::write_file(file, fuzz::text_of(data, size));
  try {
    recording::Labels labels = recording::read_labels(file);
    std::vector<recording::Labels::Recorded> pictures;
    for (int number = 0; number < 8; ++number) {
      pictures.push_back({number, std::to_string(number) + ".png"});
    }
    try {
      labels.join(pictures);
    } catch (const std::invalid_argument&) {
      return 0;  // of another recording
    }
    for (int number = 0; number < 8; ++number) {
      const recording::Labels::Boxes* boxes = labels.of(number);
      if (!boxes) continue;
      for (const recording::LabelledBox& box : *boxes) {
        // at a million pixels the width of a thin box may round to zero
        fuzz::require(box.right >= box.left && box.bottom >= box.top && box.id >= -1,
                      "boxes are boxes");
        fuzz::require(std::isfinite(box.left + box.top + box.right + box.bottom), "of numbers");
      }
    }
  } catch (const input::Error& error) {
    fuzz::require(std::string_view(error.what()).starts_with(file.string() + ":"),
                  "an error begins with the file");
  }
  return 0;
}
