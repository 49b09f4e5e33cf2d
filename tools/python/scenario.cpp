#include "tools/python/scenario.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

#include "scenarios/input/reader.h"
#include "scenarios/load.h"
#include "scenarios/scenes.h"
#include "tools/bench/detector.h"
#include "tools/python/arrays.h"
#include "tools/python/type.h"
#include "tools/replay/playback.h"

namespace lcs::python {
namespace {

/// Parses a seed by the rules of `--seed`; absent for None.
std::optional<std::uint64_t> seed_of(const OptionalSeed& seed) {
  if (seed.is_none()) return std::nullopt;
  const input::Value value{input::Value::Kind::scalar, {"seed", 0}, py::str(py::handle(seed))};
  return input::as_seed(value, "the seed");
}

std::shared_ptr<Scenario> made_of(scenario::Scenario asked) {
  auto made = std::make_shared<Scenario>();
  if (asked.recording) {
    const replay::Playback playback(asked);
    made->full = playback.scenario();
    made->camera = {playback.camera(), made->full.camera.rate_hz};
  } else {
    made->full = asked;
    made->camera = {sim::lens_of(asked.camera).pinhole(), asked.camera.rate_hz};
  }
  made->asked = std::move(asked);
  warn(scenario::shadowed_files(made->full));
  bench::filter_parameters(made->full);  // only to check the settings
  return made;
}

std::shared_ptr<Scenario> from_file(const std::filesystem::path& file, const Settings& set,
                                    const OptionalSeed& seed) {
  return made_of(scenario::load(file, {.sets = assignments_of(set), .seed = seed_of(seed)}));
}

std::shared_ptr<Scenario> from_yaml(const std::string& text, const std::filesystem::path& file,
                                    const Settings& set, const OptionalSeed& seed) {
  return made_of(scenario::load(input::parse_document(text, file), file,
                                {.sets = assignments_of(set), .seed = seed_of(seed)}));
}

Camera camera_of(double focal, double cx, double cy, int width, int height, double rate) {
  return {{focal, {cx, cy}, width, height}, rate};
}

py::array intrinsic_matrix(const Camera& camera) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = K(1, 1) = camera.focal_px;
  K.block<2, 1>(0, 2) = camera.centre_px;
  return copy(K);
}

void bind_camera(py::module_& module) {
  class_of<Camera>(
      module, "Camera",
      "A pinhole with square pixels and no distortion: x right, y down, z forward, pixels with\n"
      "(0, 0) at the centre of the top-left one.")
      .def(py::init(&camera_of), py::kw_only(), py::arg("focal"), py::arg("cx"), py::arg("cy"),
           py::arg("width"), py::arg("height"), py::arg("rate") = 0.0,
           "focal, cx, cy in pixels; width, height of the picture; rate in Hz, 0 where it is not "
           "known.")
      .def_readonly("fx", &Camera::focal_px, "px")
      .def_readonly("fy", &Camera::focal_px, "px, as fx")
      .def_property_readonly(
          "cx", [](const Camera& c) { return c.centre_px.x(); }, "px")
      .def_property_readonly(
          "cy", [](const Camera& c) { return c.centre_px.y(); }, "px")
      .def_readonly("width", &Camera::width_px, "px")
      .def_readonly("height", &Camera::height_px, "px")
      .def_readonly("rate", &Camera::rate_hz, "Pictures a second, Hz; 0: not known.")
      .def_property_readonly("matrix", &intrinsic_matrix, "K, 3 x 3 float64, in pixels.")
      .def("__repr__", [](const Camera& c) {
        return fmt::format("Camera(focal={}, cx={}, cy={}, width={}, height={}, rate={})",
                           c.focal_px, c.centre_px.x(), c.centre_px.y(), c.width_px, c.height_px,
                           c.rate_hz);
      });
}

}  // namespace

std::vector<std::string> assignments_of(const py::object& mapping, const std::string& prefix) {
  std::vector<std::string> assignments;
  if (mapping.is_none()) return assignments;
  if (!py::hasattr(mapping, "items")) {
    throw py::type_error("set is no mapping; give one, as {\"ego.speed\": \"0.7 m/s\"}");
  }
  for (const py::handle item : mapping.attr("items")()) {
    auto [key, value] = py::cast<std::pair<py::object, py::object>>(item);
    if (py::hasattr(value, "item")) value = value.attr("item")();  // a NumPy scalar
    if (!py::isinstance<py::str>(key)) {
      throw py::type_error("a key of set is " + py::cast<std::string>(py::repr(key)) +
                           "; give the name of one");
    }
    std::string text;
    if (py::isinstance<py::bool_>(value)) {
      text = py::cast<bool>(value) ? "true" : "false";
    } else if (py::isinstance<py::str>(value) || py::isinstance<py::int_>(value) ||
               py::isinstance<py::float_>(value)) {
      text = py::str(value);
    } else {
      throw py::type_error(fmt::format("set['{}'] is {}; give text, as in a scenario, or a number",
                                       py::cast<std::string>(key),
                                       py::cast<std::string>(py::repr(value))));
    }
    assignments.push_back(prefix + py::cast<std::string>(key) + '=' + text);
  }
  return assignments;
}

void warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1) != 0) throw py::error_already_set();
  }
}

void bind_scenario(py::module_& module) {
  bind_camera(module);
  class_of<Scenario, std::shared_ptr<Scenario>>(
      module, "Scenario",
      "A scenario to simulate, or a recording: a YAML file of the form in scenarios/README.md.")
      .def(py::init(&from_file), py::arg("file"), py::kw_only(), py::arg("set") = py::none(),
           py::arg("seed") = py::none(),
           R"(Reads and checks the whole file.

set: values that replace the file's, as in lcs run --set: {"ego.speed": "0.7 m/s"}.
seed: replaces the file's.
Raises Error with file, line, problem and remedy. Warns of settings of the filter that have no
effect.)")
      .def_static(
          "from_yaml", &from_yaml, py::arg("text"), py::kw_only(),
          py::arg("file") = std::filesystem::path("scenario.yaml"), py::arg("set") = py::none(),
          py::arg("seed") = py::none(),
          R"(A scenario from YAML text. file: a path that gives the name, and the folder from which relative paths
begin; it need not exist.)")
      .def_property_readonly(
          "name", [](const Scenario& s) { return s.full.name; }, "The file's stem.")
      .def_property_readonly("file", [](const Scenario& s) { return s.full.file; })
      .def_property_readonly(
          "purpose", [](const Scenario& s) { return s.full.purpose; }, "One line.")
      .def_property_readonly(
          "groups", [](const Scenario& s) { return s.full.groups; },
          "Groups of the scenario, such as \"short\".")
      .def_property_readonly("seed", [](const Scenario& s) { return s.full.seed; })
      .def_property_readonly(
          "frames", [](const Scenario& s) { return s.full.frames; },
          "Number of frames; for a recording an upper bound.")
      .def_property_readonly(
          "recorded", [](const Scenario& s) { return s.full.recording.has_value(); },
          "Whether the frames come from a recording instead of a simulation.")
      .def_readonly("camera", &Scenario::camera)
      .def("__repr__", [](const Scenario& s) {
        return fmt::format("<lcs.Scenario {}: {} frames, seed {}>", s.full.name, s.full.frames,
                           s.full.seed);
      });
}

}  // namespace lcs::python
