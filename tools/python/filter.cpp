#include "tools/python/frame.h"

#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "filter/detect/gap_picture.h"
#include "tools/bench/detector.h"
#include "tools/bench/timed.h"
#include "tools/explain/explainer.h"
#include "tools/python/arrays.h"
#include "tools/python/type.h"
#include "tools/recording/box.h"

namespace lcs::python {
namespace {

/// A filter and the pictures in which it looks at gaps.
struct PictureFilter {
  PictureFilter(const Intrinsics& camera, const AnyParameters& parameters)
      : filter(camera, parameters), pictures(camera) {}
  AnyFilter filter;
  GapPicture pictures;
};

PictureFilter of_scenario(const Scenario& scenario) {
  return {bench::intrinsics(scenario.camera), bench::filter_parameters(scenario.full)};
}

/// A filter with this camera, preset and settings, validated like a scenario's.
PictureFilter of_camera(const Camera& camera, const std::string& preset, const Settings& set) {
  scenario::Scenario settings;
  settings.filter_preset = preset;
  settings.filter_preset_source = {"preset", 0};
  for (const std::string& assignment : assignments_of(set)) {
    const std::size_t equals = assignment.find('=');
    settings.filter.push_back(
        {assignment.substr(0, equals), assignment.substr(equals + 1), {"set " + assignment, 0}});
  }
  return {bench::intrinsics(camera), bench::filter_parameters(settings)};
}

std::shared_ptr<Result> step(PictureFilter& own, const ArrayLike& corners, const EgoMotion& motion,
                             const OptionalArray& signatures, const OptionalArray& picture) {
  const std::vector<Eigen::Vector2f> corners_px = points_of(corners, "corners");
  GapView* view = nullptr;
  if (!picture.is_none()) {
    own.pictures.show(grey_of(picture));
    view = &own.pictures;
  }
  std::optional<std::vector<Signature>> given;
  if (!signatures.is_none()) given = signatures_of(signatures);
  auto result = std::make_shared<Result>();
  result->said = bench::timed(result->step_ms, [&]() -> const FrameResult& {
    return given ? own.filter.step(corners_px, *given, motion, view)
                 : own.filter.step(corners_px, motion, view);
  });
  return result;
}

/// The numbers behind a verdict of the last frame, as `lcs explain --json` names them.
py::object explained(const PictureFilter& own, int corner) {
  const Filter* plain = own.filter.plain();
  if (plain == nullptr)
    throw std::invalid_argument("only the preset default explains its verdicts");
  const std::optional<Explanation> why = plain->explain(corner);
  if (!why) return py::none();
  return py::module_::import("json").attr("loads")(explain::json_of(*why).dump());
}

/// A view of a list of one-byte enumerators. \param list a member of `FrameResult`.
template <class Enum>
py::array codes(const py::object& self, std::vector<Enum> FrameResult::*list) {
  static_assert(sizeof(Enum) == 1);
  const std::vector<Enum>& values = self.cast<const Result&>().said.*list;
  return view({std::ssize(values)}, reinterpret_cast<const std::uint8_t*>(values.data()), self);
}

py::array rebels(const Result& result) {
  const std::vector<Verdict>& verdicts = result.said.verdicts;
  py::array_t<bool> flags(std::ssize(verdicts));
  std::ranges::transform(verdicts, flags.mutable_data(),
                         [](Verdict verdict) { return verdict == Verdict::rebel; });
  return read_only(flags);
}

/// All edges or circles, the normal ones first, then the rebel ones.
template <class Item>
py::array both(const std::vector<Item>& normal, const std::vector<Item>& rebel) {
  std::vector<Item> all = normal;
  all.insert(all.end(), rebel.begin(), rebel.end());
  return rows(std::move(all));
}

py::array boxes(const Result& result) {
  return table<4>(result.said.layers.squares, recording::edges_of);
}

py::list outlines(const Result& result) {
  py::list all;
  for (const Square& square : result.said.layers.squares) {
    all.append(table<2>(square.outline.vertices(), std::identity()));
  }
  return all;
}

void bind_result(py::module_& module) {
  class_of<Result, std::shared_ptr<Result>>(
      module, "Result",
      R"(The answer of a detector to a frame. Structured arrays have the fields of layers.jsonl; places are in
pixels, angles in rad, speeds in px/s.)")
      .def_property_readonly(
          "verdicts", [](const py::object& self) { return codes(self, &FrameResult::verdicts); },
          "N uint8, a Verdict for each corner.")
      .def_property_readonly(
          "reasons", [](const py::object& self) { return codes(self, &FrameResult::reasons); },
          "N uint8, a Reason for each verdict.")
      .def_property_readonly(
          "log_odds",
          [](const py::object& self) {
            const std::vector<float>& odds = self.cast<const Result&>().said.log_odds;
            return view({std::ssize(odds)}, odds.data(), self);
          },
          "N float32: log odds that each corner moves by itself; empty with the presets lab and "
          "cars.")
      .def_property_readonly("rebels", &rebels, "N bool: the corners that move by themselves.")
      .def_property_readonly(
          "edges",
          [](const Result& r) {
            return both(r.said.layers.normal_edges, r.said.layers.rebel_edges);
          },
          R"(Tracked corners, the normal ones first: id, rebel, x, y, trust, age, speed, angle, corner (index of
its corner, -1: none), circle (index among the circles of its kind, -1: none), ...)")
      .def_property_readonly(
          "circles",
          [](const Result& r) {
            return both(r.said.layers.normal_circles, r.said.layers.rebel_circles);
          },
          "Groups of edges: id, rebel, x, y, radius, speed, angle, trust, age, members, ...")
      .def_property_readonly(
          "squares", [](const Result& r) { return rows(r.said.layers.squares); },
          "Objects: id, x, y, half_width, half_height, speed, angle, trust, age, circles,\n"
          "rebel_circles, ...")
      .def_property_readonly("boxes", &boxes,
                             "M x 4 float64: left, top, right, bottom of the squares, pixel edges.")
      .def_property_readonly(
          "outlines", &outlines,
          R"(For each square K x 2 float64: x, y of the convex hull of its edges, clockwise in the picture;
empty with the presets lab and cars.)")
      .def_property_readonly(
          "ignored", [](const Result& r) { return rows(r.said.paper.ignored); },
          "Regions psi, whose corners were ignored: shape (1: circle, 2: rectangle), x, y, size_x, "
          "size_y.")
      .def_property_readonly(
          "collectors", [](const Result& r) { return rows(r.said.paper.collectors); },
          "Regions lambda: x, y, radius, depth_ratio.");
}

}  // namespace

void bind_filter(py::module_& module) {
  bind_result(module);
  class_of<PictureFilter>(
      module, "Filter",
      "The Line-Circle-Square filter. The same corners, signatures and motions give the same bits.")
      .def(py::init(&of_scenario), py::arg("scenario"),
           "With the scenario's camera, preset and settings.")
      .def(
          py::init(&of_camera), py::arg("camera"), py::arg("preset") = "default", py::kw_only(),
          py::arg("set") = py::none(),
          R"(preset: default, lab or cars. set: parameters that replace the preset's, by the keys of
filter/parameters.cpp: {"circle.gap": 0.3}; angles in degrees.
Raises Error for an unknown preset, key or value, ValueError for an impossible camera.)")
      .def("step", &step, py::arg("corners"), py::arg("motion"), py::arg("signatures") = py::none(),
           py::kw_only(), py::arg("picture") = py::none(),
           R"(Processes the next frame.

corners: N x 2, x and y in pixels; motion: since the last frame; signatures: N x 32 uint8;
picture: height x width uint8, grey, without distortion. Bodies that approach at constant speed are
found only with pictures, and only by the preset default.
Raises TypeError or ValueError for arrays of another type or shape, and then ignores the frame.
Numbers that are not finite or out of range never raise: they are left out, see diagnostics.)")
      .def(
          "explain", &explained, py::arg("corner"),
          R"(The numbers behind the verdict on a corner of the last frame, by its index: track, age,
assigned (the track that it was assigned to, 0: none), numbers (of MODEL.md, by name and unit) and
neighbours (corner, k and tanh(m/2) each). None for a corner that the filter has left out, or the frame lacks.
Raises ValueError with the presets lab and cars.)")
      .def_property_readonly(
          "diagnostics", [](const PictureFilter& f) { return f.filter.diagnostics().lines(); },
          "Problems of the data so far, a line for each kind.");
}

}  // namespace lcs::python
