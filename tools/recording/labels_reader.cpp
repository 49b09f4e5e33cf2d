#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/files/csv.h"
#include "tools/files/json_node.h"
#include "tools/input/input_file.h"
#include "tools/input/message.h"
#include "tools/recording/labels.h"

namespace lcs::bench {
namespace {

constexpr input::FileKind kLabelsFile{
    256 * input::kMebibyte, "give boxes as gt.txt of MOTChallenge has them, or COCO's JSON"};

constexpr double kFarthest_px = 1e6;
constexpr int kMostPictures = 100'000'000;

/// \throws std::invalid_argument; the caller puts the place before its message.
void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

LabelledBox box_of(int id, double left, double top, double width, double height) {
  for (const double number : {left, top, width, height}) {
    require(std::abs(number) <= kFarthest_px, "the box is not within a million pixels");
  }
  require(width > 0 && height > 0, "the box has no area");
  return {.id = id, .left = left, .top = top, .right = left + width, .bottom = top + height};
}

/// The object ids that each image has already.
class Ids {
 public:
  void add(const std::string& picture, int id) {
    require(id < 0 || seen_.emplace(picture, id).second,
            fmt::format("object {} has a box in that picture already", id));
  }

 private:
  std::set<std::pair<std::string, int>> seen_;
};

class MotRow {
 public:
  explicit MotRow(std::string_view line) : fields_(fields_of(line)) {
    require(
        fields_.size() >= 6,
        fmt::format("{} fields are too few for FRAME,ID,LEFT,TOP,WIDTH,HEIGHT", fields_.size()));
  }
  double number(std::size_t field, const char* what) const {
    const std::optional<double> number = number_in<double>(fields_[field]);
    require(number.has_value(),
            fmt::format("{} is '{}', which is no number", what, fields_[field]));
    return *number;
  }
  /// Parses an integer; some files write 3.0 for 3.
  int whole(std::size_t field, const char* what, int least, int most) const {
    const double value = number(field, what);
    require(value == std::floor(value) && value >= least && value <= most,
            fmt::format("{} is '{}', which is not a whole number from {}", what, fields_[field],
                        least));
    return static_cast<int>(value);
  }
  bool has(std::size_t field) const { return field < fields_.size(); }

 private:
  std::vector<std::string_view> fields_;
};

void read_mot_row(std::string_view line, Labels& labels, Ids& ids) {
  const MotRow row(line);
  const int picture = row.whole(0, "the frame", 1, kMostPictures);
  const int id = row.whole(1, "the id", -1, kMostPictures);
  LabelledBox box = box_of(id, row.number(2, "the left side") - 1, row.number(3, "the top") - 1,
                           row.number(4, "the width"), row.number(5, "the height"));
  box.ignored = row.has(6) && row.number(6, "the seventh field") == 0;
  ids.add(std::to_string(picture), id);
  labels.at(picture - 1).push_back(box);
}

Labels read_mot(const std::filesystem::path& file) {
  input::InputFile input(file, kLabelsFile);
  Labels labels;
  Ids ids;
  for (std::string line; input.next_line(line);) {
    if (trimmed(line).empty()) continue;
    try {
      read_mot_row(line, labels, ids);
    } catch (const std::invalid_argument& error) {
      throw input::Error(input.here(),
                         input::printable(fmt::format("{}; {}", error.what(), kLabelsFile.remedy)));
    }
  }
  return labels;
}

/// COCO file names may begin with folders.
std::string file_name_of(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

std::map<std::uint64_t, Labels::Boxes*> read_images(const JsonNode& images, Labels& labels) {
  std::map<std::uint64_t, Labels::Boxes*> by_id;
  images.each([&](const JsonNode& image) {
    const std::size_t before = labels.pictures();
    const bool is_numbered = image.has("frame_id");
    Labels::Boxes& boxes = is_numbered ? labels.at(image["frame_id"].natural<int>())
                                       : labels.at(file_name_of(image["file_name"].text()));
    image[is_numbered ? "frame_id" : "file_name"].require(labels.pictures() > before,
                                                          "one that no other image has");
    const bool is_new = by_id.emplace(image["id"].natural(), &boxes).second;
    image["id"].require(is_new, "one that no other image has");
  });
  return by_id;
}

void read_annotation(const JsonNode& annotation,
                     const std::map<std::uint64_t, Labels::Boxes*>& images, Ids& ids) {
  const std::uint64_t image = annotation["image_id"].natural();
  const auto found = images.find(image);
  annotation["image_id"].require(found != images.end(), "the id of an image in the list");
  const int id = annotation.has("track_id") ? annotation["track_id"].natural<int>() : -1;
  const auto [left, top, width, height] = annotation["bbox"].numbers<4>();
  try {
    LabelledBox box = box_of(id, left, top, width, height);
    box.ignored = annotation.has("iscrowd") && annotation["iscrowd"].natural() != 0;
    ids.add(std::to_string(image), id);
    found->second->push_back(box);
  } catch (const std::invalid_argument& error) {
    annotation["bbox"].require(false, fmt::format("that of a mover: {}", error.what()));
  }
}

Labels read_coco(const std::filesystem::path& file) {
  return read_json(file, kLabelsFile, [](const JsonNode& json) {
    Labels labels;
    Ids ids;
    const auto images = read_images(json["images"], labels);
    json["annotations"].each(
        [&](const JsonNode& annotation) { read_annotation(annotation, images, ids); });
    return labels;
  });
}

/// The first character other than blanks and line ends; a byte order mark is skipped.
char first_of(const std::filesystem::path& file) {
  input::InputFile input(file, kLabelsFile);
  for (std::string line; input.next_line(line);) {
    if (!trimmed(line).empty()) return trimmed(line).front();
  }
  throw input::Error({file.string(), 0}, fmt::format("is empty; {}", kLabelsFile.remedy));
}

}  // namespace

const Labels::Boxes* Labels::of(int number, const std::string& name) const {
  if (const auto found = by_name_.find(name); found != by_name_.end()) return &found->second;
  const auto found = by_number_.find(number);
  return found != by_number_.end() ? &found->second : nullptr;
}

Labels read_labels(const std::filesystem::path& file) {
  return first_of(file) == '{' ? read_coco(file) : read_mot(file);
}

}  // namespace lcs::bench
