#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "scenarios/input_file.h"
#include "scenarios/message.h"
#include "tools/bench/csv.h"
#include "tools/bench/detections.h"
#include "tools/bench/recording_fields.h"

namespace lcs::bench {
namespace {

constexpr int kUnnamed = -1;

/// \throws std::invalid_argument, whose message goes behind file and line.
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

/// As if the detector had found nothing: every corner is normal.
Recording without_verdicts(const Recording& sequence) {
  Recording recording = unspoken(sequence);
  for (FrameRecord& frame : recording.frames) {
    frame.verdicts.assign(frame.corners_px.size(), Verdict::normal);
  }
  return recording;
}

class RowReader {
 public:
  explicit RowReader(Detections& detections) : detections_(detections) {
    std::vector<FrameRecord>& frames = detections.recording.frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      frames_.emplace(frames[i].index,
                      Frame{&frames[i], std::vector<char>(frames[i].corners_px.size()), {}});
    }
  }

  /// \throws std::invalid_argument
  void read(const std::vector<std::string_view>& row) {
    if (row.size() < 2) refuse("a row begins with FRAME,TYPE; there is one field");
    Frame& frame = frame_of(row[0]);
    const std::string_view type = row[1];
    const std::span<const std::string_view> values = std::span(row).subspan(2);
    const auto verdict = std::find(kVerdicts.begin(), kVerdicts.end(), type);
    if (verdict != kVerdicts.end()) {
      read_verdict(frame, static_cast<Verdict>(verdict - kVerdicts.begin()), values);
    } else if (type == "box") {
      read_box(frame, values);
    } else if (type == "square") {
      read_square(frame, values);
    } else if (type == "circle") {
      read_circle(frame, values);
    } else {
      refuse("there is no type '{}'; give {}, box, square or circle", type,
             fmt::join(kVerdicts, ", "));
    }
  }

 private:
  struct Frame {
    FrameRecord* record;
    std::vector<char> named;  // corners that have a verdict
    std::set<Id> boxes;
  };

  Frame& frame_of(std::string_view text) {
    const std::optional<int> index = number_in<int>(text);
    if (!index) refuse("the frame is '{}'; give its number", text);
    const auto found = frames_.find(*index);
    if (found != frames_.end()) return found->second;
    if (frames_.empty()) {
      refuse("there is no frame {}: the sequence has none; leave its rows out", *index);
    }
    refuse("there is no frame {}: the sequence has {} to {}; give one of these", *index,
           frames_.begin()->first, frames_.rbegin()->first);
  }

  void read_verdict(Frame& frame, Verdict verdict, std::span<const std::string_view> values) {
    const char* const word = kVerdicts[static_cast<std::size_t>(verdict)];
    int corner = kUnnamed;
    if (values.size() == 1) {
      corner = corner_by_index(frame, values[0]);
    } else if (values.size() == 2) {
      corner = corner_at(frame, {number(values[0], "x"), number(values[1], "y")});
    } else {
      refuse("names no corner; write FRAME,{0},X,Y or FRAME,{0},INDEX", word);
    }
    ++detections_.verdicts;
    if (corner == kUnnamed) return;
    frame.record->verdicts[corner] = verdict;
    frame.named[corner] = 1;
  }

  static int corner_by_index(const Frame& frame, std::string_view text) {
    const std::size_t count = frame.named.size();
    const std::optional<std::size_t> index = number_in<std::size_t>(text);
    if (!index) refuse("the corner is '{}'; give its index from 0 on, or x and y", text);
    if (*index >= count) {
      refuse("there is no corner {}: frame {} has {}; count them from 0", *index,
             frame.record->index, count);
    }
    if (frame.named[*index]) {
      refuse("corner {} of frame {} has a verdict already; give one for each", *index,
             frame.record->index);
    }
    return static_cast<int>(*index);
  }

  /// The nearest corner that has no verdict yet; counts what finds none.
  int corner_at(const Frame& frame, const Vec2& place_px) {
    int nearest = kUnnamed;
    double least = kCornerReach_px;
    bool any = false;
    for (std::size_t i = 0; i < frame.named.size(); ++i) {
      const double distance = (frame.record->corners_px[i].cast<double>() - place_px).norm();
      if (distance > kCornerReach_px) continue;
      any = true;
      if (frame.named[i] || (nearest != kUnnamed && distance >= least)) continue;
      nearest = static_cast<int>(i);
      least = distance;
    }
    if (nearest == kUnnamed) ++(any ? detections_.repeated : detections_.without_corner);
    return nearest;
  }

  /// From pixel edges to the centres of pixels, where corners and squares are measured.
  static void read_box(Frame& frame, std::span<const std::string_view> values) {
    if (values.size() != 5) {
      refuse("not all of a box is there; write FRAME,box,ID,LEFT,TOP,WIDTH,HEIGHT");
    }
    const Vec2 corner(number(values[1], "left"), number(values[2], "top"));
    const Vec2 size(above_zero(values[3], "width"), above_zero(values[4], "height"));
    add_square(frame, id_in(values[0]), corner + 0.5 * size - Vec2(0.5, 0.5), 0.5 * size);
  }

  static void read_square(Frame& frame, std::span<const std::string_view> values) {
    if (values.size() != 5) {
      refuse("not all of a square is there; write FRAME,square,ID,X,Y,HALF_WIDTH,HALF_HEIGHT");
    }
    add_square(frame, id_in(values[0]), {number(values[1], "x"), number(values[2], "y")},
               {above_zero(values[3], "half width"), above_zero(values[4], "half height")});
  }

  static void add_square(Frame& frame, Id id, const Vec2& location, const Vec2& half_size) {
    std::vector<Square>& squares = frame.record->layers.squares;
    if (!frame.boxes.insert(id).second) {
      refuse("frame {} has a box {} already; an id is one object's", frame.record->index, id);
    }
    Square square;
    square.id = id;
    square.location = location;
    square.half_size = half_size;
    squares.push_back(square);
  }

  static void read_circle(Frame& frame, std::span<const std::string_view> values) {
    if (values.size() != 3) refuse("not all of a circle is there; write FRAME,circle,X,Y,RADIUS");
    Circle circle;
    circle.rebel = true;
    circle.location = {number(values[0], "x"), number(values[1], "y")};
    circle.radius = number(values[2], "radius");
    if (circle.radius < 0) refuse("the radius is {}; it must be 0 or more", values[2]);
    std::vector<Circle>& circles = frame.record->layers.rebel_circles;
    circle.id = static_cast<Id>(circles.size());
    circles.push_back(circle);
  }

  Detections& detections_;
  std::map<int, Frame> frames_;
};

}  // namespace

Detections read_detections(const std::filesystem::path& csv, const Recording& sequence) {
  // A thousand rows for each of a million frames.
  constexpr scenario::FileKind kDetectionsTable{64 * scenario::kGibibyte,
                                                "name a CSV file of detections"};
  scenario::InputFile file(csv, kDetectionsTable);
  Detections detections;
  detections.recording = without_verdicts(sequence);
  detections.recording.detector = {.name = csv.stem().string(), .layered = false};
  RowReader reader(detections);
  std::string line;
  bool header_may_come = true;
  while (file.next_line(line)) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const std::vector<std::string_view> row = fields_of(text);
    const bool is_header = header_may_come && row.front() == "frame";
    header_may_come = false;
    if (is_header) continue;
    try {
      reader.read(row);
    } catch (const std::invalid_argument& error) {
      throw scenario::Error(file.here(), error.what());
    }
  }
  return detections;
}

}  // namespace lcs::bench
