#include "tools/recording/detections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"
#include "tools/files/csv.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"

namespace lcs::recording {
namespace {

/// \throws std::invalid_argument; the caller puts file and line, or the frame, before its message.
template <class... Arguments>
[[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  // A NUL character would end the message.
  throw std::invalid_argument(
      input::printable(fmt::format(text, std::forward<Arguments>(arguments)...)));
}

template <class Number = double>
Number number(std::string_view text, const char* what, const char* remedy = "give a number") {
  const std::optional<Number> value = files::number_in<Number>(text);
  if (!value) refuse("{} is '{}'; {}", what, text, remedy);
  return *value;
}

void require_finite(double value, const char* what) {
  if (!std::isfinite(value)) refuse("{} is {}; give a number", what, value);
}
void require_above_zero(double value, const char* what) {
  require_finite(value, what);
  if (value <= 0) refuse("{} is {}; it must be above 0", what, value);
}
void require_not_negative(double value, const char* what) {
  require_finite(value, what);
  if (value < 0) refuse("{} is {}; it must be 0 or more", what, value);
}

Id id_in(std::string_view text) {
  return number<Id>(text, "the id", "give a whole number from 0 on");
}

Box widened(const Box& box, double by_px) {
  return {box.min().array() - by_px, box.max().array() + by_px};
}

/// Parses a list of numbers, or one COCO string that holds them all.
std::vector<std::int64_t> counts_in(std::span<const std::string_view> counts) {
  if (counts.size() == 1) return unpacked_runs(counts[0]);
  std::vector<std::int64_t> runs;
  for (const std::string_view text : counts) {
    runs.push_back(number<std::int64_t>(text, "a count of the mask", "give whole numbers"));
  }
  return runs;
}

using Frames = std::map<int, FrameDetections>;  ///< by index

/// \throws std::invalid_argument; the caller puts file and line before its message.
FrameDetections& frame_of(std::string_view text, Frames& frames) {
  const int index = number<int>(text, "the frame", "give its number");
  const auto found = frames.find(index);
  if (found != frames.end()) return found->second;
  if (frames.empty()) {
    refuse("there is no frame {}: the sequence has none; leave its rows out", index);
  }
  refuse("there is no frame {}: the sequence has {} to {}; give one of these", index,
         frames.begin()->first, frames.rbegin()->first);
}

/// The image size; without a camera, the least size that holds the mask and all corners.
cv::Size size_for(const sim::Mask& mask, const FrameRecord& frame,
                  const std::optional<Intrinsics>& camera) {
  if (camera) return {camera->width_px, camera->height_px};
  cv::Size size(mask.box.x + mask.box.width, mask.box.y + mask.box.height);
  for (const Eigen::Vector2f& corner : frame.corners_px) {
    size.width = std::max(size.width, static_cast<int>(corner.x()) + 1);
    size.height = std::max(size.height, static_cast<int>(corner.y()) + 1);
  }
  return size;
}

std::string rows_of(const FrameRecord& frame, const std::optional<Intrinsics>& camera) {
  std::string rows;
  const int k = frame.index;
  for (std::size_t i = 0; i < frame.verdicts.size(); ++i) {
    if (frame.verdicts[i] == Verdict::normal) continue;
    rows += fmt::format("{},{},{}\n", k, kVerdicts[static_cast<std::size_t>(frame.verdicts[i])], i);
  }
  for (const Square& square : frame.layers.squares) {
    if (const auto mask = frame.masks.find(square.id); mask != frame.masks.end()) {
      const cv::Size size = size_for(mask->second, frame, camera);
      const sim::PixelRuns runs = sim::runs_in({{}, size}, mask->second);
      rows += fmt::format("{},mask,{},{},{},{}\n", k, square.id, size.height, size.width,
                          packed_runs(runs));
      continue;
    }
    rows += fmt::format("{},square,{},{},{},{},{}", k, square.id, square.location.x(),
                        square.location.y(), square.half_size.x(), square.half_size.y());
    for (const Vec2& vertex : square.outline.vertices()) {
      rows += fmt::format(",{},{}", vertex.x(), vertex.y());
    }
    rows += '\n';
  }
  for (const Circle& circle : frame.layers.rebel_circles) {
    rows += fmt::format("{},circle,{},{},{}\n", k, circle.location.x(), circle.location.y(),
                        circle.radius);
  }
  return rows;
}

}  // namespace

VerdictCounts& VerdictCounts::operator+=(const VerdictCounts& other) {
  verdicts += other.verdicts;
  without_corner += other.without_corner;
  repeated += other.repeated;
  return *this;
}

std::vector<std::string> lines_of(const VerdictCounts& counts) {
  std::vector<std::string> lines;
  if (counts.without_corner > 0) {
    lines.push_back(fmt::format("{} of {} verdicts are on no corner: there is none within {} px",
                                counts.without_corner, counts.verdicts, kCornerReach_px));
  }
  if (counts.repeated > 0) {
    lines.push_back(
        fmt::format("{} of {} verdicts are on a corner that has one already: the nearest holds",
                    counts.repeated, counts.verdicts));
  }
  return lines;
}

FrameDetections::FrameDetections(FrameRecord& frame, const std::optional<Intrinsics>& camera)
    : frame_(&frame), named_(frame.corners_px.size()) {
  if (camera) picture_px_.emplace(camera->width_px, camera->height_px);
  frame.verdicts.assign(frame.corners_px.size(), Verdict::normal);
}

void FrameDetections::add(std::string_view type, std::span<const std::string_view> values) {
  const auto require = [&](bool are_all, const char* names) {
    if (!are_all) refuse("not all of a {} is there; give {}", type, names);
  };
  const auto pair = [&](std::size_t first, const char* x, const char* y) {
    const double of_x = number(values[first], x);
    return Vec2(of_x, number(values[first + 1], y));
  };
  const auto verdict = std::ranges::find(kVerdicts, type);
  if (verdict != kVerdicts.end()) {
    add_verdict(static_cast<Verdict>(verdict - kVerdicts.begin()), values);
  } else if (type == "box") {
    require(values.size() == 5, "ID,LEFT,TOP,WIDTH,HEIGHT");
    const Vec2 corner = pair(1, "left", "top"), size = pair(3, "width", "height");
    add_box(id_in(values[0]), corner, size);
  } else if (type == "mask") {
    require(values.size() >= 4, "ID,HEIGHT,WIDTH,COUNTS");
    const auto side = [&](std::size_t i, const char* what) {
      const std::optional<int> px = files::number_in<int>(values[i]);
      if (!px || *px < 1) refuse("{} is '{}'; give the picture's size", what, values[i]);
      return *px;
    };
    const cv::Size size_px(side(2, "the mask's width"), side(1, "the mask's height"));
    require_picture(size_px);
    const Id id = id_in(values[0]);
    add_mask(id, sim::mask_of(counts_in(values.subspan(3)), size_px), size_px);
  } else if (type == "square") {
    require(values.size() >= 5 && values.size() % 2 == 1,
            "ID,X,Y,HALF_WIDTH,HALF_HEIGHT[,X,Y,...], the latter of its outline");
    Square square;
    square.id = id_in(values[0]);
    square.location = pair(1, "x", "y");
    square.half_size = pair(3, "half width", "half height");
    const std::size_t points = (values.size() - 5) / 2;
    if (points > Outline::kMost) {
      refuse("the outline has {} points; give {} at the most", points, Outline::kMost);
    }
    square.outline.count = static_cast<int>(points);
    for (std::size_t i = 5; Vec2 & vertex : square.outline.vertices()) {
      vertex = pair(i, "x of the outline", "y of the outline");
      i += 2;
    }
    add_square(square);
  } else if (type == "circle") {
    gives_circles_ = true;
    require(values.empty() || values.size() == 3, "X,Y,RADIUS, or nothing");
    if (!values.empty()) add_circle(pair(0, "x", "y"), number(values[2], "radius"));
  } else {
    refuse("there is no type '{}'; give {}, box, mask, square or circle", type,
           fmt::join(kVerdicts, ", "));
  }
}

void FrameDetections::add_verdict(Verdict verdict, std::span<const std::string_view> values) {
  if (values.size() == 1) {
    const auto corner =
        number<std::size_t>(values[0], "the corner", "give its index from 0 on, or x and y");
    if (corner >= named_.size()) {
      refuse("there is no corner {}: frame {} has {}; count them from 0", corner, frame_->index,
             named_.size());
    }
    if (named_[corner]) {
      refuse("corner {} of frame {} has a verdict already; give one for each", corner,
             frame_->index);
    }
    frame_->verdicts[corner] = verdict;
    named_[corner] = 1;
  } else if (values.size() == 2) {
    const Vec2 place(number(values[0], "x"), number(values[1], "y"));
    require_in_picture("corner", {place, place}, kCornerReach_px);
    if (placed_.size() == kMostPlaces) {
      refuse("there are more than {} verdicts by place in the frame; give the corners' indices",
             kMostPlaces);
    }
    placed_.push_back({verdict, place});
  } else {
    refuse("{} names no corner; give it an INDEX, or X,Y",
           kVerdicts[static_cast<std::size_t>(verdict)]);
  }
  ++counts_.verdicts;
}

void FrameDetections::require_picture(const cv::Size& size_px) const {
  if (picture_px_) {
    if (size_px == *picture_px_) return;
    refuse(
        "the mask is of {} x {} pixels, and the picture of {} x {}; give one of the picture's size",
        size_px.width, size_px.height, picture_px_->width, picture_px_->height);
  }
  if (std::max(size_px.width, size_px.height) > kMostSide_px) {
    refuse("the mask is of {} x {} pixels; a picture has no side of more than {}", size_px.width,
           size_px.height, kMostSide_px);
  }
  for (const Eigen::Vector2f& corner : frame_->corners_px) {
    if (corner.x() < static_cast<float>(size_px.width) &&
        corner.y() < static_cast<float>(size_px.height)) {
      continue;
    }
    refuse(
        "the mask is of {} x {} pixels, and a corner lies at {}, {}; give one of the picture's "
        "size",
        size_px.width, size_px.height, corner.x(), corner.y());
  }
}

/// \param margin_px widens the image, which the shape has to touch; 0: it has to overlap the image.
void FrameDetections::require_in_picture(const char* what, const Box& shape,
                                         double margin_px) const {
  constexpr double kMostSides = 10;  // longest allowed reach beyond the image, in image sides
  const auto where = [&] {
    const std::string from = fmt::format("{}, {}", shape.min().x(), shape.min().y());
    return shape.min() == shape.max() ? fmt::format("the {} at {}", what, from)
                                      : fmt::format("the {} from {} to {}, {}", what, from,
                                                    shape.max().x(), shape.max().y());
  };
  if (!picture_px_) {
    if (shape.min().cwiseAbs().cwiseMax(shape.max().cwiseAbs()).maxCoeff() > 2 * kMostSide_px) {
      refuse("{} lies farther out than any picture reaches; give pixels", where());
    }
    return;
  }
  const auto& [width, height] = *picture_px_;
  const Box picture(Vec2(-0.5, -0.5), Vec2(width - 0.5, height - 0.5));
  const Box common = widened(picture, margin_px).intersection(shape);
  if (margin_px > 0 ? common.isEmpty() : !((common.sizes().array() > 0).all())) {
    refuse("{} lies outside of the picture, which has {} x {} pixels; leave out what is not in it",
           where(), width, height);
  }
  if (!widened(picture, kMostSides * std::max(width, height)).contains(shape)) {
    refuse(
        "{} reaches more than {} times as far as the picture, which has {} x {} pixels; clip it to "
        "the picture",
        where(), kMostSides, width, height);
  }
}

void FrameDetections::add_box(Id id, const Vec2& corner, const Vec2& size) {
  require_finite(corner.x(), "left");
  require_finite(corner.y(), "top");
  require_above_zero(size.x(), "width");
  require_above_zero(size.y(), "height");
  add_square(square_of(id, corner, size));
}

void FrameDetections::add_mask(Id id, sim::Mask mask, const cv::Size& size_px) {
  require_picture(size_px);
  if (mask.box.empty()) refuse("the mask has no pixel; leave out what is not seen");
  add_square(square_of(mask, id));
  frame_->masks[id] = std::move(mask);
}

void FrameDetections::add_square(const Square& square) {
  constexpr double kThinnest_px = 1;  // thinner squares need only touch the image, not overlap it
  if (square.id > kMostId) {
    refuse("the id is {}; give a whole number up to {}", square.id, kMostId);
  }
  require_finite(square.location.x(), "x");
  require_finite(square.location.y(), "y");
  require_not_negative(square.half_size.x(), "half width");
  require_not_negative(square.half_size.y(), "half height");
  const bool is_thin = 2 * square.half_size.minCoeff() < kThinnest_px;
  require_in_picture("box", box_of(square), is_thin ? kThinnest_px : 0);
  if (Box outline; square.outline.count > 0) {
    for (const Vec2& vertex : square.outline.vertices()) outline.extend(vertex);
    require_in_picture("outline", outline, kThinnest_px);
  }
  std::vector<Square>& squares = frame_->layers.squares;
  if (squares.size() == kMostBoxes) {
    refuse("there are more than {} boxes in the frame; give objects' boxes", kMostBoxes);
  }
  if (!boxes_.insert(square.id).second) {
    refuse("the frame has a box {} already; an id is one object's", square.id);
  }
  squares.push_back(square);
}

void FrameDetections::add_circle(const Vec2& location, double radius) {
  require_finite(location.x(), "x");
  require_finite(location.y(), "y");
  require_not_negative(radius, "the radius");
  require_in_picture("circle", widened({location, location}, radius), 1);
  std::vector<Circle>& circles = frame_->layers.rebel_circles;
  if (circles.size() == kMostCircles) {
    refuse("there are more than {} circles in the frame; give objects' circles", kMostCircles);
  }
  const auto id = static_cast<Id>(circles.size());
  circles.push_back({.id = id, .rebel = true, .location = location, .radius = radius});
}

VerdictCounts FrameDetections::finish() {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // distance, said, corner
  std::vector<char> in_reach(placed_.size()), used(placed_.size());
  for (std::size_t said = 0; said < placed_.size(); ++said) {
    for (std::size_t corner = 0; corner < named_.size(); ++corner) {
      const double distance_px =
          (frame_->corners_px[corner].cast<double>() - placed_[said].place_px).norm();
      if (distance_px > kCornerReach_px) continue;
      in_reach[said] = 1;
      if (!named_[corner]) pairs.emplace_back(distance_px, said, corner);
    }
  }
  std::ranges::sort(pairs);
  for (const auto& [distance_px, said, corner] : pairs) {
    if (used[said] || named_[corner]) continue;
    used[said] = named_[corner] = 1;
    frame_->verdicts[corner] = placed_[said].verdict;
  }
  for (std::size_t said = 0; said < placed_.size(); ++said) {
    if (!used[said]) ++(in_reach[said] ? counts_.repeated : counts_.without_corner);
  }
  placed_.clear();
  return counts_;
}

Detections read_detections(const std::filesystem::path& csv, Recording sequence) {
  // A thousand rows for each of a million frames.
  constexpr input::FileKind kDetectionsTable{64 * input::kGibibyte,
                                             "name a CSV file of detections"};
  input::InputFile file(csv, kDetectionsTable);
  Detections detections;
  detections.recording = without_detections(std::move(sequence));
  detections.recording.detector = {.name = csv.stem().string(), .layered = false};
  Frames frames;
  for (FrameRecord& frame : detections.recording.frames) {
    frames.emplace(frame.index, FrameDetections(frame, detections.recording.camera));
  }
  std::string line;
  bool header_may_come = true;
  while (file.next_line(line)) {
    const std::string_view text = files::trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const std::vector<std::string_view> row = files::fields_of(text);
    const bool is_header = header_may_come && row.front() == "frame";
    header_may_come = false;
    if (is_header) continue;
    try {
      if (row.size() < 2) refuse("a row begins with FRAME,TYPE; there is one field");
      frame_of(row[0], frames).add(row[1], std::span(row).subspan(2));
    } catch (const std::invalid_argument& error) {
      throw input::Error(file.here(), error.what());
    }
  }
  bool circles = false;
  for (auto& [index, frame] : frames) {
    detections.counts += frame.finish();
    circles |= frame.gives_circles();
  }
  detections.recording.detector.circles = circles;
  return detections;
}

DetectionsWriter::DetectionsWriter(const std::filesystem::path& csv, const RunInfo& run)
    : file_(csv), camera_(run.camera), states_circles_(run.detector.circles) {
  file_.write("frame,type\n");
}

void DetectionsWriter::write(const FrameRecord& frame) {
  if (states_circles_) file_.write(fmt::format("{},circle\n", frame.index));
  states_circles_ = false;
  file_.write(rows_of(frame, camera_));
}

void set_corner_truth(Truth truth, FrameRecord& frame) {
  sim::CornerTruth of_each;
  of_each.label = truth == Truth::nothing_moves ? sim::Label::fixed : sim::Label::none;
  frame.corner_truth.assign(frame.corners_px.size(), of_each);
}

FrameRecord without_detections(FrameRecord frame) {
  frame.verdicts.clear();
  frame.reasons.clear();
  frame.log_odds.clear();
  frame.layers = {};
  frame.paper = {};
  frame.masks.clear();
  frame.times.reset();
  return frame;
}

Recording without_detections(Recording recording) {
  recording.detector = {};
  for (FrameRecord& frame : recording.frames) frame = without_detections(std::move(frame));
  return recording;
}

}  // namespace lcs::recording
