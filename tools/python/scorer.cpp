#include "tools/python/scorer.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/python/arrays.h"
#include "tools/python/filter.h"
#include "tools/python/frame.h"
#include "tools/recording/box.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/scoring.h"

namespace lcs::python {
namespace {

/// What somebody's own detector says of a frame.
struct Detections {
  std::optional<std::vector<bool>> rebels;  ///< of each corner; none: of no corner
  std::vector<Square> squares;
  bench::SquareMasks masks;
  std::vector<Circle> circles;
};

/// Row `i` of a table of numbers. \throws py::value_error for one that is not finite.
template <int Columns>
Eigen::Matrix<double, Columns, 1> row_of(const Numbers& table, py::ssize_t i, const char* name) {
  const Eigen::Map<const Eigen::Matrix<double, Columns, 1>> row(table.data(i, 0));
  if (!row.allFinite()) {
    throw py::value_error(fmt::format("row {} of {} has what is no number; leave it out", i, name));
  }
  return row;
}

/// \param what boxes or masks.
std::vector<Id> ids_of(const py::object& ids, py::ssize_t count, const char* what) {
  if (ids.is_none() && count == 0) return {};
  if (ids.is_none()) {
    throw py::value_error(
        fmt::format("{0} have no ids, by which they are followed from frame to frame; give ids, or "
                    "ids=range(len({0})) where nothing is followed",
                    what));
  }
  const py::object list = py::isinstance<py::array>(ids) ? ids : py::object(py::list(ids));
  const py::array array = array_of(list, "ids", "a whole number for each box", "iu");
  if (array.ndim() != 1 || array.size() != count) {
    throw py::value_error(
        fmt::format("there are {} ids and {} {}; give one for each", array.size(), count, what));
  }
  std::vector<Id> numbers;
  std::set<Id> met;
  for (const py::handle each : array) {
    if (py::cast<bool>(each.attr("__lt__")(0))) {
      throw py::value_error(fmt::format("the id is {}; give a whole number from 0 on",
                                        py::cast<std::string>(py::str(each))));
    }
    const Id id = py::cast<Id>(each.attr("__int__")());
    if (!met.insert(id).second) {
      throw py::value_error(fmt::format("id {} is given twice; an id is one object's", id));
    }
    numbers.push_back(id);
  }
  return numbers;
}

std::vector<Square> squares_of(const py::object& boxes, const py::object& ids) {
  const Numbers table =
      boxes.is_none()
          ? Numbers(std::vector<py::ssize_t>{0, 4})
          : table_of(boxes, "boxes", "M x 4 numbers, left, top, right, bottom in pixels", 4);
  std::vector<Square> squares;
  const std::vector<Id> numbers = ids_of(ids, table.shape(0), "boxes");
  for (py::ssize_t i = 0; i < table.shape(0); ++i) {
    const Eigen::Vector4d edges = row_of<4>(table, i, "boxes");
    const Vec2 size = edges.tail<2>() - edges.head<2>();
    if (!(size.array() > 0).all()) {
      throw py::value_error(
          fmt::format("box {} has left {}, top {}, right {}, bottom {}; left must be less than "
                      "right, and top than bottom",
                      i, edges[0], edges[1], edges[2], edges[3]));
    }
    squares.push_back(
        bench::square_of(numbers[static_cast<std::size_t>(i)], edges.head<2>(), size));
  }
  return squares;
}

/// Masks in place of boxes, which are those round them.
void add_masks(const py::object& masks, const py::object& ids, Detections& detections) {
  const py::object list = py::isinstance<py::array>(masks) ? masks : py::object(py::list(masks));
  constexpr const char* kExpected = "M x H x W bool, which pixels each covers";
  const py::array array = array_of(list, "masks", kExpected, "b");
  if (array.size() == 0) return;
  if (array.ndim() != 3) {
    throw py::value_error(fmt::format("masks has {} dimensions; give {}", array.ndim(), kExpected));
  }
  const auto pixels = py::array_t<bool, py::array::c_style | py::array::forcecast>(array);
  const std::vector<Id> numbers = ids_of(ids, pixels.shape(0), "masks");
  for (py::ssize_t i = 0; i < pixels.shape(0); ++i) {
    cv::Mat1b picture(static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(2)));
    std::copy_n(pixels.data(i, 0, 0), picture.total(), picture.begin());
    sim::Mask mask = sim::mask_of(picture);
    if (mask.box.empty()) {
      throw py::value_error(fmt::format("mask {} has no pixel; leave out what is not seen", i));
    }
    const Id id = numbers[static_cast<std::size_t>(i)];
    detections.squares.push_back(bench::square_of(mask, id));
    detections.masks[id] = std::move(mask);
  }
}

std::vector<Circle> circles_of(const py::object& circles) {
  std::vector<Circle> made;
  if (circles.is_none()) return made;
  const Numbers table = table_of(circles, "circles", "K x 3 numbers, x, y and radius in pixels", 3);
  for (py::ssize_t i = 0; i < table.shape(0); ++i) {
    const Eigen::Vector3d row = row_of<3>(table, i, "circles");
    if (row[2] < 0) {
      throw py::value_error(
          fmt::format("circle {} has the radius {}; it must be 0 or more", i, row[2]));
    }
    Circle& circle = made.emplace_back();
    circle.id = static_cast<Id>(i);
    circle.rebel = true;
    circle.location = row.head<2>();
    circle.radius = row[2];
  }
  return made;
}

Detections detections_of(const py::object& rebels, const py::object& boxes, const py::object& ids,
                         const py::object& circles, const py::object& masks) {
  Detections detections;
  if (!rebels.is_none()) detections.rebels = flags_of(rebels, "rebels");
  if (!masks.is_none() && !boxes.is_none()) {
    throw py::value_error("there are boxes and masks; give masks alone, whose boxes are known");
  }
  if (masks.is_none()) {
    detections.squares = squares_of(boxes, ids);
  } else {
    add_masks(masks, ids, detections);
  }
  detections.circles = circles_of(circles);
  return detections;
}

class Scorer {
 public:
  void add(const Frame& frame, const py::object& said) {
    const bool is_filter = py::isinstance<Result>(said);
    if (!is_filter && !py::isinstance<Detections>(said)) {
      return add(frame,
                 py::cast(detections_of(said, py::none(), py::none(), py::none(), py::none())));
    }
    require_next(frame, is_filter);
    bench::FrameRecord record = frame.seen.record;
    if (is_filter) {
      const auto& result = said.cast<const Result&>();
      require_all_corners(frame, result.said.verdicts.size());
      bench::note(result.said, &bench::FrameTimes::filter_ms, result.filter_ms, record);
    } else {
      const auto& detections = said.cast<const Detections&>();
      record.times.reset();
      record.verdicts.assign(record.corners_px.size(), Verdict::normal);
      if (detections.rebels) {
        require_all_corners(frame, detections.rebels->size());
        std::transform(detections.rebels->begin(), detections.rebels->end(),
                       record.verdicts.begin(),
                       [](bool rebel) { return rebel ? Verdict::rebel : Verdict::normal; });
      }
      record.layers.squares = detections.squares;
      record.masks = detections.masks;
      record.layers.rebel_circles = detections.circles;
    }
    if (!run_) {
      run_ = frame.run;
      recording_ = run_->recording;
      recording_.detector = {.name = is_filter ? "lcs" : "python", .layered = is_filter};
    }
    recording_.frames.push_back(std::move(record));
  }

  /// In the order of metrics.json.
  py::dict metrics() {
    if (run_) recording_.warnings = run_->recording.warnings;
    py::dict figures;
    for (const auto& [name, figure] : bench::score(recording_)) figures[name.c_str()] = figure;
    return figures;
  }

  std::vector<std::string> warnings() {
    if (run_) recording_.warnings = run_->recording.warnings;
    return bench::lines_of(bench::warnings_of(recording_));
  }

 private:
  void require_next(const Frame& frame, bool is_filter) const {
    if (run_ && run_ != frame.run) {
      throw py::value_error("this frame is of another run; give each run a Scorer of its own");
    }
    const std::size_t due = recording_.frames.size();
    const int index = frame.seen.record.index;
    if (static_cast<std::size_t>(index) != due) {
      throw py::value_error(fmt::format(
          "frame {} comes where frame {} is due; give all frames in order", index, due));
    }
    if (run_ && recording_.detector.layered != is_filter) {
      throw py::value_error(
          "some frames have a Result of the filter and others something else; give each detector a "
          "Scorer of its own");
    }
  }

  static void require_all_corners(const Frame& frame, std::size_t verdicts) {
    const bench::FrameRecord& record = frame.seen.record;
    if (verdicts == record.corners_px.size()) return;
    throw py::value_error(fmt::format(
        "there are verdicts on {} corners, and frame {} has {}; give one for each of frame.corners",
        verdicts, record.index, record.corners_px.size()));
  }

  std::shared_ptr<const Run> run_;  ///< none until a frame is added
  bench::Recording recording_;
};

}  // namespace

void bind_scorer(py::module_& module) {
  py::class_<Detections>(module, "Detections", "What somebody's own detector says of a frame.")
      .def(
          py::init(&detections_of), py::arg("rebels") = py::none(), py::kw_only(),
          py::arg("boxes") = py::none(), py::arg("ids") = py::none(),
          py::arg("circles") = py::none(), py::arg("masks") = py::none(),
          "rebels: N bool, which of the frame's corners move by themselves; none where not given.\n"
          "boxes: M x 4, left, top, right, bottom, pixel edges: a box over columns l to r-1 has "
          "left l and right\n"
          "r. ids: M whole numbers from 0 on, which stay with their objects from frame to frame.\n"
          "masks: in place of boxes, M x H x W bool: the pixels that each covers.\n"
          "circles: K x 3, x, y, radius in pixels: groups of rebels, by which false objects are "
          "counted.\n"
          "Raises TypeError or ValueError for what is none of these.");
  py::class_<Scorer>(module, "Scorer",
                     "Scores a run's frames, one after another, without keeping their pictures.")
      .def(py::init<>())
      .def("add", &Scorer::add, py::arg("frame"), py::arg("said"),
           "said: a Result of the filter, Detections, or N bool, which of the frame's corners are "
           "rebels.\n"
           "Frames come in order, each once, from the first on; what raises counts for nothing.")
      .def("metrics", &Scorer::metrics,
           "All figures of metrics.json (tools/scoring/SCORING.md) by name; None where undefined. "
           "Times and\n"
           "sizes are those of the filter; of other detectors they are None.")
      .def_property_readonly("warnings", &Scorer::warnings,
                             "What should not be, a line each, as lcs run tells it.");
}

}  // namespace lcs::python
