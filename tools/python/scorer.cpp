// The Python classes that score any detector's results on a run's frames by the bench's scorer.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "tools/bench/detector.h"
#include "tools/python/arrays.h"
#include "tools/python/frame.h"
#include "tools/python/type.h"
#include "tools/recording/detections.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/scoring.h"

namespace lcs::python {
namespace {

/// A user's detector's results for one frame.
struct Detections {
  std::optional<std::vector<bool>> rebels;  ///< per corner; absent: no corner is a rebel
  recording::FrameRecord boxes;             ///< has only squares, masks and circles
  cv::Size masks_px;                        ///< size of the masks' picture
};

/// Prefixes `who` to the message of an exception of `FrameDetections`.
template <class Add>
void add_or_refuse(const std::string& who, const Add& add) {
  try {
    add();
  } catch (const std::invalid_argument& error) {
    throw py::value_error(fmt::format("{}: {}", who, error.what()));
  }
}

/// Returns an array unchanged. Of another iterable, which may be endless, lists the first items.
py::object listed(const py::object& items, py::ssize_t most) {
  if (py::isinstance<py::array>(items)) return items;
  py::list list;
  for (const py::handle each : py::iter(items)) {
    if (std::ssize(list) == most) break;
    list.append(each);
  }
  return list;
}

/// \param what "boxes" or "masks".
std::vector<Id> ids_of(const py::object& ids, py::ssize_t count, const char* what) {
  if (ids.is_none() && count == 0) return {};
  if (ids.is_none()) {
    throw py::value_error(
        fmt::format("{0} have no ids, by which they are followed from frame to frame; give ids, or "
                    "ids=range(len({0})) where nothing is followed",
                    what));
  }
  const py::array array =
      array_of(listed(ids, count + 1), "ids", "a whole number for each box", "iu");
  if (array.ndim() != 1 || array.size() != count) {
    throw py::value_error(fmt::format("there are {}{} ids and {} {}; give one for each",
                                      array.size() > count ? "at least " : "", array.size(), count,
                                      what));
  }
  std::vector<Id> numbers;
  for (const py::handle each : array) {
    if (py::cast<bool>(each.attr("__lt__")(0))) {
      throw py::value_error(fmt::format("the id is {}; give a whole number from 0 on",
                                        py::cast<std::string>(py::str(each))));
    }
    numbers.push_back(py::cast<Id>(each.attr("__int__")()));
  }
  return numbers;
}

void add_boxes(const py::object& boxes, const py::object& ids, recording::FrameDetections& said) {
  const Numbers table =
      boxes.is_none()
          ? Numbers(std::vector<py::ssize_t>{0, 4})
          : table_of(boxes, "boxes", "M x 4 numbers, left, top, right, bottom in pixels", 4);
  const std::vector<Id> numbers = ids_of(ids, table.shape(0), "boxes");
  for (py::ssize_t i = 0; i < table.shape(0); ++i) {
    const Eigen::Map<const Eigen::Vector4d> edges(table.data(i, 0));
    const Vec2 corner = edges.head<2>();
    add_or_refuse(fmt::format("box {}", i), [&] {
      said.add_box(numbers[static_cast<std::size_t>(i)], corner, edges.tail<2>() - corner);
    });
  }
}

/// Adds masks, whose bounding boxes become the boxes. \return the size of the masks' picture.
cv::Size add_masks(const py::object& masks, const py::object& ids,
                   recording::FrameDetections& said) {
  constexpr const char* kExpected = "M x H x W bool, which pixels each covers";
  const py::array array =
      array_of(listed(masks, recording::kMostBoxes + 1), "masks", kExpected, "b");
  if (array.ndim() == 1 && array.size() == 0) {  // an empty list
    ids_of(ids, 0, "masks");
    return {};
  }
  if (array.ndim() != 3) {
    throw py::value_error(fmt::format("masks has {} dimensions; give {}", array.ndim(), kExpected));
  }
  const py::ssize_t height = array.shape(1), width = array.shape(2);
  const bool has_size = std::min(height, width) > 0 &&
                        std::max(height, width) <= recording::kMostSide_px &&
                        array.shape(0) <= static_cast<py::ssize_t>(recording::kMostBoxes);
  if (!has_size) {
    throw py::value_error(
        fmt::format("masks are {} of {} x {} pixels; give {} at the most, of the picture's size",
                    array.shape(0), width, height, recording::kMostBoxes));
  }
  const cv::Size size_px(static_cast<int>(width), static_cast<int>(height));
  const std::vector<Id> numbers = ids_of(ids, array.shape(0), "masks");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    add_or_refuse(fmt::format("mask {}", i), [&] {
      const py::array_t<bool, py::array::c_style | py::array::forcecast> pixels(
          array.attr("__getitem__")(i));
      cv::Mat1b picture(size_px);
      std::copy_n(pixels.data(), picture.total(), picture.begin());
      said.add_mask(numbers[i], sim::mask_of(picture), size_px);
    });
  }
  return size_px;
}

void add_circles(const py::object& circles, recording::FrameDetections& said) {
  if (circles.is_none()) return;
  const Numbers table = table_of(circles, "circles", "K x 3 numbers, x, y and radius in pixels", 3);
  for (py::ssize_t i = 0; i < table.shape(0); ++i) {
    const double* const row = table.data(i, 0);
    add_or_refuse(fmt::format("circle {}", i), [&] { said.add_circle({row[0], row[1]}, row[2]); });
  }
}

/// Checks everything except the fit to the picture, which is not known yet.
Detections detections_of(const OptionalArray& rebels, const OptionalArray& boxes,
                         const OptionalArray& ids, const OptionalArray& circles,
                         const OptionalArray& masks) {
  Detections detections;
  if (!rebels.is_none()) detections.rebels = flags_of(rebels, "rebels");
  if (!masks.is_none() && !boxes.is_none()) {
    throw py::value_error("there are boxes and masks; give masks alone, whose boxes are known");
  }
  recording::FrameDetections said(detections.boxes, std::nullopt);
  if (masks.is_none()) {
    add_boxes(boxes, ids, said);
  } else {
    detections.masks_px = add_masks(masks, ids, said);
  }
  add_circles(circles, said);
  return detections;
}

/// Adds the detections to a frame's record and checks them against the frame's camera.
void note(const Detections& detections, const Frame& frame, recording::FrameRecord& record) {
  const auto& [layers, masks] = std::tie(detections.boxes.layers, detections.boxes.masks);
  add_or_refuse(fmt::format("frame {}", record.index), [&] {
    recording::FrameDetections said(record, bench::intrinsics(frame.run->scenario->camera));
    for (const Square& square : layers.squares) {
      if (const auto mask = masks.find(square.id); mask != masks.end()) {
        said.add_mask(square.id, mask->second, detections.masks_px);
      } else {
        said.add_square(square);
      }
    }
    for (const Circle& circle : layers.rebel_circles) {
      said.add_circle(circle.location, circle.radius);
    }
  });
}

class Scorer {
 public:
  void add(const Frame& frame, const py::object& said) {
    const bool is_result = py::isinstance<Result>(said);
    if (!is_result && !py::isinstance<Detections>(said)) {
      const OptionalArray none{py::none()};
      return add(frame, py::cast(detections_of(OptionalArray(said), none, none, none, none)));
    }
    const recording::DetectorInfo detector =
        is_result ? said.cast<const Result&>().detector
                  : recording::DetectorInfo{.name = "python", .layered = false};
    require_next(frame, detector);
    recording::FrameRecord record = frame.seen.record;
    if (is_result) {
      const auto& result = said.cast<const Result&>();
      require_all_corners(frame, result.said.verdicts.size());
      if (!result.wants_signatures) {  // as in a run of its own
        record.signatures = {};
        if (record.times) record.times->describe_ms = 0;
      }
      bench::store_result(result.said, result.step_time, result.step_ms, record);
      record.masks = result.masks;
    } else {
      const auto& detections = said.cast<const Detections&>();
      record.times.reset();
      note(detections, frame, record);
      if (detections.rebels) {
        require_all_corners(frame, detections.rebels->size());
        std::ranges::transform(*detections.rebels, record.verdicts.begin(),
                               [](bool rebel) { return rebel ? Verdict::rebel : Verdict::normal; });
      }
    }
    if (!run_) {
      recording::RunInfo info = frame.run->info;
      info.detector = detector;
      detector_ = detector.name;
      scorer_.emplace(info);
    }
    scorer_->add(record);
    run_ = frame.run;
  }

  /// The figures in the order of metrics.json.
  py::dict metrics() {
    py::dict figures;
    for (const auto& [name, figure] : scorer_->metrics(world())) figures[name.c_str()] = figure;
    return figures;
  }

  std::vector<std::string> warnings() { return recording::lines_of(scorer_->warned(world())); }

 private:
  std::optional<sim::Warnings> world() const { return run_ ? run_->info.warnings : std::nullopt; }

  void require_next(const Frame& frame, const recording::DetectorInfo& detector) const {
    if (run_ && run_ != frame.run) {
      throw py::value_error("this frame is of another run; give each run a Scorer of its own");
    }
    const int due = scorer_->frames();
    const int index = frame.seen.record.index;
    if (index != due) {
      throw py::value_error(fmt::format(
          "frame {} comes where frame {} is due; give all frames in order", index, due));
    }
    if (run_ && detector_ != detector.name) {
      throw py::value_error(
          fmt::format("some frames have a result of {} and this one has one of {}; give each "
                      "detector a Scorer of its own",
                      detector_, detector.name));
    }
  }

  static void require_all_corners(const Frame& frame, std::size_t verdicts) {
    const recording::FrameRecord& record = frame.seen.record;
    if (verdicts == record.corners_px.size()) return;
    throw py::value_error(fmt::format(
        "there are verdicts on {} corners, and frame {} has {}; give one for each of frame.corners",
        verdicts, record.index, record.corners_px.size()));
  }

  std::shared_ptr<const Run> run_;  ///< null until a frame is added
  std::string detector_;
  std::optional<scoring::Scorer> scorer_{std::in_place, recording::RunInfo{}};
};

}  // namespace

void bind_scorer(py::module_& module) {
  class_of<Detections>(module, "Detections", "The answer of your own detector to a frame.")
      .def(
          py::init(&detections_of), py::arg("rebels") = py::none(), py::kw_only(),
          py::arg("boxes") = py::none(), py::arg("ids") = py::none(),
          py::arg("circles") = py::none(), py::arg("masks") = py::none(),
          R"(rebels: N bool, True for corners of the frame that move by themselves; None: no verdicts.
boxes: M x 4, left, top, right, bottom, pixel edges: a box over columns l to r-1 has left l and
right r. ids: M whole numbers from 0, which stay with their objects from frame to frame.
masks: in place of boxes, M x H x W bool: the pixels of each object.
circles: K x 3, x, y, radius in pixels: groups of rebels, by which false objects are counted.
Raises TypeError or ValueError for arrays of another type or shape. Scorer.add checks places and the
size of masks against the camera.)");
  // Lambdas with references, because with member functions pybind11 would accept None as self.
  class_of<Scorer>(module, "Scorer",
                   "Scores a run's frames, one after another, without keeping their pictures.")
      .def(py::init<>())
      .def(
          "add",
          [](Scorer& scorer, const Frame& frame, const Answer& said) { scorer.add(frame, said); },
          py::arg("frame"), py::arg("said"),
          R"(said: a Result of the filter or of a Detector, Detections, or N bool, True for rebels among the
frame's corners. Give the frames in order, from the first on, each once. A call that raises adds
nothing. Raises ValueError for places outside of the picture (tools/recording/DETECTIONS.md).)")
      .def(
          "metrics", [](Scorer& scorer) { return scorer.metrics(); },
          R"(All figures of metrics.json (tools/scoring/SCORING.md) by name; None where undefined. Times and sizes
are known for the filter only.)")
      .def_property_readonly(
          "warnings", [](Scorer& scorer) { return scorer.warnings(); },
          "Problems of the run so far, a line each, as lcs run prints them.");
}

}  // namespace lcs::python
