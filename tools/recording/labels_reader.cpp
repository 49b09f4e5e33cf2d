#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <set>
#include <stdexcept>
#include <utility>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"
#include "tools/files/csv.h"
#include "tools/files/json_node.h"
#include "tools/recording/labels.h"

namespace lcs::recording {
namespace {

constexpr input::FileKind kLabelsFile{
    256 * input::kMebibyte,
    "give boxes as gt.txt of MOTChallenge has them, COCO's JSON, or KITTI tracking's labels"};

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
using Ids = std::set<std::pair<std::uint64_t, int>>;

void require_new(std::uint64_t picture, int id, Ids& ids) {
  require(id < 0 || ids.emplace(picture, id).second,
          fmt::format("object {} has a box in that picture already", id));
}

/// Fields of a text row.
struct LabelRow {
  std::vector<std::string_view> fields;

  LabelRow(std::vector<std::string_view> fields_, std::size_t least, const char* format)
      : fields(std::move(fields_)) {
    require(fields.size() >= least,
            fmt::format("{} fields are too few for {}", fields.size(), format));
  }
  double number(std::size_t field, const char* what) const {
    const std::optional<double> number = files::number_in<double>(fields[field]);
    require(number.has_value(), fmt::format("{} is '{}', which is no number", what, fields[field]));
    return *number;
  }
  /// Parses an integer; some files write 3.0 for 3.
  int whole(std::size_t field, const char* what, int least, int most) const {
    const double value = number(field, what);
    require(
        value == std::floor(value) && value >= least && value <= most,
        fmt::format("{} is '{}', which is not a whole number from {}", what, fields[field], least));
    return static_cast<int>(value);
  }
};

/// Boxes by the number in their rows.
struct Numbered {
  std::map<int, Labels::Boxes> boxes;
  Ids ids;

  void add(int number, const LabelledBox& box) {
    require_new(static_cast<std::uint64_t>(number), box.id, ids);
    boxes[number].push_back(box);
  }
};

Labels read_rows(const std::filesystem::path& file, const auto& read_row) {
  input::InputFile input(file, kLabelsFile);
  Numbered numbered;
  for (std::string line; input.next_line(line);) {
    if (files::trimmed(line).empty()) continue;
    try {
      read_row(line, numbered);
    } catch (const std::invalid_argument& error) {
      throw input::Error(input.here(),
                         input::printable(fmt::format("{}; {}", error.what(), kLabelsFile.remedy)));
    }
  }
  Labels labels;
  for (const auto& [number, boxes] : numbered.boxes) labels.pictures.push_back({number, "", boxes});
  return labels;
}

Labels read_mot(const std::filesystem::path& file) {
  Labels labels = read_rows(file, [](std::string_view line, Numbered& numbered) {
    const LabelRow row(files::fields_of(line), 6, "FRAME,ID,LEFT,TOP,WIDTH,HEIGHT");
    const int picture = row.whole(0, "the frame", 0, kMostPictures);
    const int id = row.whole(1, "the id", -1, kMostPictures);
    LabelledBox box = box_of(id, row.number(2, "the left side") - 1, row.number(3, "the top") - 1,
                             row.number(4, "the width"), row.number(5, "the height"));
    box.ignored = row.fields.size() > 6 && row.number(6, "the seventh field") == 0;
    numbered.add(picture, box);
  });
  const bool has_zero = !labels.pictures.empty() && labels.pictures.front().number == 0;
  labels.first = has_zero ? 0 : 1;
  if (has_zero) labels.remarks.emplace_back("labels: their frames count from 0, not from 1");
  return labels;
}

Labels read_kitti(const std::filesystem::path& file) {
  Labels labels = read_rows(file, [](std::string_view line, Numbered& numbered) {
    const LabelRow row(files::words_of(line), 10,
                       "FRAME ID TYPE TRUNCATED OCCLUDED ALPHA LEFT TOP RIGHT BOTTOM");
    const double left = row.number(6, "the left side"), top = row.number(7, "the top");
    LabelledBox box =
        box_of(row.whole(1, "the id", -1, kMostPictures), left, top,
               row.number(8, "the right side") - left, row.number(9, "the bottom") - top);
    box.ignored = row.fields[2] == "DontCare";
    numbered.add(row.whole(0, "the frame", 0, kMostPictures), box);
  });
  labels.first = 0;
  labels.remarks.emplace_back(
      "labels: KITTI's boxes are of all objects, also of those at rest, which then count as "
      "missed");
  return labels;
}

/// A whole number, also as 3.0; some converters write floats.
std::uint64_t id_in(const files::JsonNode& node, double most = 1e15) {
  const double number = node.number();
  node.require(number >= 0 && number <= most && number == std::floor(number),
               "a whole number from 0");
  return static_cast<std::uint64_t>(number);
}
int count_in(const files::JsonNode& node) {
  return static_cast<int>(id_in(node, kMostPictures));
}

/// The id of the video whose labels are read; absent if the file has only one, or none.
std::optional<std::uint64_t> video_in(const files::JsonNode& json, const std::string& video) {
  std::map<std::string, std::uint64_t> ids;
  if (json.has("videos")) {
    json["videos"].each([&](const files::JsonNode& one) {
      const std::string name = one.has("name")        ? one["name"].text()
                               : one.has("file_name") ? one["file_name"].text()
                                                      : std::to_string(id_in(one["id"]));
      ids[name] = id_in(one["id"]);
    });
  }
  const auto names = std::views::keys(ids);
  if (const auto found = ids.find(video); found != ids.end()) return found->second;
  if (!video.empty()) {
    throw files::JsonNode::Error(
        fmt::format("there is no video {}, but {}", video, fmt::join(names, ", ")));
  }
  if (ids.size() < 2) return std::nullopt;
  throw files::JsonNode::Error(
      fmt::format("it has several videos: {}; name one (labels_video)", fmt::join(names, ", ")));
}

Labels read_coco(const std::filesystem::path& file, const std::string& video) {
  return files::read_json(file, kLabelsFile, [&](const files::JsonNode& json) {
    Labels labels;
    Ids ids;
    const std::optional<std::uint64_t> only = video_in(json, video);
    std::map<std::uint64_t, std::optional<std::size_t>>
        places;  // by image id; of other videos none
    std::set<std::pair<std::string, int>> seen;
    json["images"].each([&](const files::JsonNode& image) {
      const bool is_other = only && image.has("video_id") && id_in(image["video_id"]) != *only;
      const auto place = is_other ? std::nullopt : std::optional(labels.pictures.size());
      image["id"].require(places.emplace(id_in(image["id"]), place).second,
                          "one that no other image has");
      if (is_other) return;
      Labels::Picture picture;
      const bool is_numbered = image.has("frame_id");
      if (is_numbered) picture.number = count_in(image["frame_id"]);
      if (!is_numbered || image.has("file_name")) {
        picture.name = image["file_name"].text();
        std::ranges::replace(picture.name, '\\', '/');
      }
      const bool is_new = seen.emplace(picture.name, picture.number.value_or(-1)).second;
      image[is_numbered ? "frame_id" : "file_name"].require(is_new, "one that no other image has");
      labels.pictures.push_back(picture);
    });
    if (json.has("categories")) {
      std::vector<std::string> names;
      json["categories"].each([&](const files::JsonNode& category) {
        if (category.has("name")) names.push_back(category["name"].text());
      });
      labels.remarks.push_back(fmt::format("labels: boxes of all categories count as movers: {}",
                                           fmt::join(names, ", ")));
    }
    int flat = 0;
    json["annotations"].each([&](const files::JsonNode& annotation) {
      const std::uint64_t image = id_in(annotation["image_id"]);
      const auto found = places.find(image);
      annotation["image_id"].require(found != places.end(), "the id of an image in the list");
      if (!found->second) return;
      const int id = annotation.has("track_id") ? count_in(annotation["track_id"]) : -1;
      const auto [left, top, width, height] = annotation["bbox"].numbers<4>();
      if (width * height == 0) {
        ++flat;
        return;
      }
      try {
        LabelledBox box = box_of(id, left, top, width, height);
        const auto is_crowd = [](const files::JsonNode& flag) {
          return flag.json().is_boolean() ? flag.flag() : flag.number() != 0;
        };
        box.ignored = annotation.has("iscrowd") && is_crowd(annotation["iscrowd"]);
        require_new(image, id, ids);
        labels.pictures[*found->second].boxes.push_back(box);
      } catch (const std::invalid_argument& error) {
        annotation["bbox"].require(false, fmt::format("a mover's box: {}", error.what()));
      }
    });
    if (flat > 0) {
      labels.remarks.push_back(fmt::format("labels: {} boxes have no area and are left out", flat));
    }
    return labels;
  });
}

/// The first line with a character; a byte order mark is skipped.
std::string first_line(const std::filesystem::path& file) {
  input::InputFile input(file, kLabelsFile);
  for (std::string line; input.next_line(line);) {
    if (!files::trimmed(line).empty()) return std::string(files::trimmed(line));
  }
  throw input::Error({file.string(), 0}, "is empty; {}", kLabelsFile.remedy);
}

/// The last parts of a path, at most `count`, between slashes.
std::string end_of(const std::string& name, std::size_t count) {
  std::size_t at = name.size();
  for (; count > 0 && at > 0 && at != name.npos; --count) at = name.rfind('/', at - 1);
  return at == name.npos || at == 0 ? name : name.substr(at + 1);
}

}  // namespace

std::vector<std::string> Labels::join(const std::vector<Recorded>& recorded, std::size_t images,
                                      std::optional<std::size_t> named_first) {
  picture_of_.clear();
  const auto join_by = [&](const auto& key_of_recorded, const auto& key_of_label) {
    std::map<std::string, int> numbers;  // -1: of several images
    for (const Recorded& image : recorded) {
      const auto [at, is_new] = numbers.emplace(key_of_recorded(image), image.number);
      if (!is_new) at->second = -1;
    }
    std::map<int, std::size_t> joined;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const auto found = numbers.find(key_of_label(pictures[i]));
      if (found == numbers.end() || found->first.empty() || found->second < 0) continue;
      const auto [other, is_new] = joined.emplace(found->second, i);
      if (is_new) continue;
      if (!picture_of_.empty()) return;  // with more folders they differ
      throw std::invalid_argument(
          fmt::format("{} and {} may both be the picture {}: rename its folder to that of one",
                      pictures[other->second].name, pictures[i].name, found->first));
    }
    if (joined.size() > picture_of_.size()) picture_of_ = std::move(joined);
  };
  std::size_t parts = 1;
  for (const Picture& picture : pictures) {
    parts = std::max(parts, files::split(picture.name, '/').size());
  }
  std::vector<std::string> lines = remarks;
  for (const bool whole : {true, false}) {
    for (std::size_t count = parts; count > 0; --count) {
      const auto name = [&](const auto& image) {
        const std::filesystem::path end = end_of(image.name, count);
        return whole ? end.string() : (end.parent_path() / end.stem()).string();
      };
      join_by(name, name);
    }
    if (picture_of_.empty()) continue;
    if (!whole) {
      lines.emplace_back("labels: they name pictures with other endings than the recording");
    }
    break;
  }
  std::vector<std::size_t> stated;
  for (const Picture& picture : pictures) {
    if (picture.number) stated.push_back(static_cast<std::size_t>(*picture.number));
  }
  if (picture_of_.empty() && !stated.empty() && !recorded.empty()) {
    const bool by_name = recorded.front().named.has_value();
    if (images == 0) images = static_cast<std::size_t>(recorded.back().number) + 1;
    const auto [least, most] = std::ranges::minmax(stated);
    const bool is_from_one = least > 0 && (named_first == 1UL || (least == 1 && most == images));
    const std::size_t from = static_cast<std::size_t>(first.value_or(is_from_one ? 1 : 0));
    const bool are_same = by_name && !named_first;
    if (!first && !are_same)
      lines.push_back(fmt::format("labels: frame_id is taken to count from {}", from));
    join_by(
        [&](const Recorded& image) {
          return std::to_string(image.named.value_or(static_cast<std::size_t>(image.number)));
        },
        [&](const Picture& picture) {
          if (!picture.number) return std::string();
          const auto number = static_cast<std::size_t>(*picture.number);
          return std::to_string(are_same ? number : number - from + named_first.value_or(0));
        });
    if (!picture_of_.empty()) {
      const Picture& joined = pictures[picture_of_.begin()->second];
      const auto image = std::ranges::find(recorded, picture_of_.begin()->first, &Recorded::number);
      lines.push_back(fmt::format(
          "labels: frame {} is {}, by the {} of the pictures", *joined.number,
          image->name.empty() ? fmt::format("picture {}", image->number) : end_of(image->name, 1),
          by_name ? "numbers in the names" : "order"));
      if (!by_name && most >= images + from) {
        throw std::invalid_argument(fmt::format(
            "they go to frame {}, and the recording has {} pictures, whose names do not count them",
            most, images));
      }
    }
  }
  std::size_t boxes = 0, all = 0;
  for (const Picture& picture : pictures) all += picture.boxes.size();
  for (const auto& [number, place] : picture_of_) boxes += pictures[place].boxes.size();
  const std::string count = fmt::format(
      "{} of {} labelled pictures, with {} of {} boxes, belong to the {} pictures of the recording",
      picture_of_.size(), pictures.size(), boxes, all, recorded.size());
  if (picture_of_.empty()) {
    const auto called = [](const std::string& of, std::optional<int> number) {
      return of.empty() ? fmt::format("picture {}", number.value_or(0)) : of;
    };
    throw std::invalid_argument(
        pictures.empty() || recorded.empty()
            ? count
            : fmt::format(
                  "{}: the first labels are of {}, and the recording begins with {}", count,
                  called(pictures[0].name, pictures[0].number),
                  called(end_of(recorded[0].name, 1), recorded[0].number + first.value_or(0))));
  }
  lines.push_back("labels: " + count);
  return lines;
}

const Labels::Boxes* Labels::of(int number) const {
  const auto found = picture_of_.find(number);
  return found == picture_of_.end() ? nullptr : &pictures[found->second].boxes;
}

Labels read_labels(const std::filesystem::path& file, const std::string& video) {
  const std::string line = first_line(file);
  if (line.front() == '{') return read_coco(file, video);
  return line.find(',') == line.npos && line.find(' ') != line.npos ? read_kitti(file)
                                                                    : read_mot(file);
}

}  // namespace lcs::recording
