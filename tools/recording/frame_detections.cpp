#include "tools/recording/frame_detections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "scenarios/message.h"
#include "tools/files/csv.h"
#include "tools/recording/box.h"
#include "tools/recording/coco_mask.h"
#include "tools/recording/recording_fields.h"

namespace lcs::bench {
namespace {

/// \throws std::invalid_argument, whose message goes behind file and line, or the frame.
template <class... Arguments>
[[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  // A NUL would end the message.
  throw std::invalid_argument(
      scenario::printable(fmt::format(text, std::forward<Arguments>(arguments)...)));
}

double number(std::string_view text, const char* what) {
  const std::optional<double> value = number_in<double>(text);
  if (!value) refuse("{} is '{}'; give a number", what, text);
  return *value;
}

double above_zero(std::string_view text, const char* what) {
  const double value = number(text, what);
  if (!(value > 0)) refuse("{} is {}; it must be above 0", what, text);
  return value;
}

Id id_in(std::string_view text) {
  const std::optional<Id> id = number_in<Id>(text);
  if (!id) refuse("the id is '{}'; give a whole number from 0 on", text);
  return *id;
}

/// Numbers, or one word that holds all of them.
std::vector<std::int64_t> counts_in(std::span<const std::string_view> counts) {
  if (counts.size() == 1) return unpacked_runs(counts[0]);
  std::vector<std::int64_t> runs;
  for (const std::string_view text : counts) {
    const std::optional<std::int64_t> run = number_in<std::int64_t>(text);
    if (!run) refuse("a count of the mask is '{}'; give whole numbers", text);
    runs.push_back(*run);
  }
  return runs;
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

FrameDetections::FrameDetections(FrameRecord& frame)
    : frame_(&frame), named_(frame.corners_px.size()) {
  frame.verdicts.assign(frame.corners_px.size(), Verdict::normal);
}

void FrameDetections::add(std::string_view type, std::span<const std::string_view> values) {
  const auto verdict = std::find(kVerdicts.begin(), kVerdicts.end(), type);
  if (verdict != kVerdicts.end()) {
    add_verdict(static_cast<Verdict>(verdict - kVerdicts.begin()), values);
  } else if (type == "box") {
    add_box(values);
  } else if (type == "mask") {
    add_mask(values);
  } else if (type == "square") {
    add_square(values);
  } else if (type == "circle") {
    add_circle(values);
  } else {
    refuse("there is no type '{}'; give {}, box, mask, square or circle", type,
           fmt::join(kVerdicts, ", "));
  }
}

void FrameDetections::add_verdict(Verdict verdict, std::span<const std::string_view> values) {
  if (values.size() == 1) {
    const std::size_t corner = corner_by_index(values[0]);
    frame_->verdicts[corner] = verdict;
    named_[corner] = 1;
  } else if (values.size() == 2) {
    placed_.push_back({verdict, {number(values[0], "x"), number(values[1], "y")}});
  } else {
    refuse("{} names no corner; give it an INDEX, or X,Y",
           kVerdicts[static_cast<std::size_t>(verdict)]);
  }
  ++counts_.verdicts;
}

std::size_t FrameDetections::corner_by_index(std::string_view text) const {
  const std::optional<std::size_t> index = number_in<std::size_t>(text);
  if (!index) refuse("the corner is '{}'; give its index from 0 on, or x and y", text);
  if (*index >= named_.size()) {
    refuse("there is no corner {}: frame {} has {}; count them from 0", *index, frame_->index,
           named_.size());
  }
  if (named_[*index]) {
    refuse("corner {} of frame {} has a verdict already; give one for each", *index, frame_->index);
  }
  return *index;
}

void FrameDetections::add_box(std::span<const std::string_view> values) {
  if (values.size() != 5) refuse("not all of a box is there; give ID,LEFT,TOP,WIDTH,HEIGHT");
  const Vec2 corner(number(values[1], "left"), number(values[2], "top"));
  const Vec2 size(above_zero(values[3], "width"), above_zero(values[4], "height"));
  put(square_of(id_in(values[0]), corner, size));
}

void FrameDetections::add_mask(std::span<const std::string_view> values) {
  if (values.size() < 4) refuse("not all of a mask is there; give ID,HEIGHT,WIDTH,COUNTS");
  const auto side = [&](std::size_t i, const char* what) {
    const std::optional<int> px = number_in<int>(values[i]);
    if (!px || *px < 1) refuse("{} is '{}'; give that of the picture", what, values[i]);
    return *px;
  };
  const cv::Size size_px(side(2, "the mask's width"), side(1, "the mask's height"));
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
  const Id id = id_in(values[0]);
  sim::Mask mask = sim::mask_of(counts_in(values.subspan(3)), size_px);
  put(square_of(mask, id));
  frame_->masks[id] = std::move(mask);
}

void FrameDetections::add_square(std::span<const std::string_view> values) {
  if (values.size() < 5 || values.size() % 2 != 1) {
    refuse(
        "not all of a square is there; give ID,X,Y,HALF_WIDTH,HALF_HEIGHT[,X,Y,...], the latter "
        "of its outline");
  }
  Square square;
  square.id = id_in(values[0]);
  square.location = {number(values[1], "x"), number(values[2], "y")};
  square.half_size = {above_zero(values[3], "half width"), above_zero(values[4], "half height")};
  Outline& outline = square.outline;
  outline.count = static_cast<int>(values.size() - 5) / 2;
  if (outline.count > Outline::kMost) {
    refuse("the outline has {} points; give {} at the most", outline.count, Outline::kMost);
  }
  for (std::size_t i = 5; Vec2 & vertex : outline.vertices()) {
    vertex.x() = number(values[i++], "x of the outline");
    vertex.y() = number(values[i++], "y of the outline");
  }
  put(square);
}

void FrameDetections::put(const Square& square) {
  if (!boxes_.insert(square.id).second) {
    refuse("frame {} has a box {} already; an id is one object's", frame_->index, square.id);
  }
  frame_->layers.squares.push_back(square);
}

void FrameDetections::add_circle(std::span<const std::string_view> values) {
  gives_circles_ = true;
  if (values.empty()) return;
  if (values.size() != 3) refuse("not all of a circle is there; give X,Y,RADIUS, or nothing");
  Circle circle;
  circle.rebel = true;
  circle.location = {number(values[0], "x"), number(values[1], "y")};
  circle.radius = number(values[2], "radius");
  if (circle.radius < 0) refuse("the radius is {}; it must be 0 or more", values[2]);
  std::vector<Circle>& circles = frame_->layers.rebel_circles;
  circle.id = static_cast<Id>(circles.size());
  circles.push_back(circle);
}

VerdictCounts FrameDetections::finish() {
  struct Pair {
    double distance_px;
    std::size_t said, corner;
  };
  std::vector<Pair> pairs;
  std::vector<char> in_reach(placed_.size()), used(placed_.size());
  for (std::size_t said = 0; said < placed_.size(); ++said) {
    for (std::size_t corner = 0; corner < named_.size(); ++corner) {
      const double distance_px =
          (frame_->corners_px[corner].cast<double>() - placed_[said].place_px).norm();
      if (distance_px > kCornerReach_px) continue;
      in_reach[said] = 1;
      if (!named_[corner]) pairs.push_back({distance_px, said, corner});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.distance_px, a.said, a.corner) < std::tie(b.distance_px, b.said, b.corner);
  });
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

}  // namespace lcs::bench
