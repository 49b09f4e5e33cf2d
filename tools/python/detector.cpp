// The Python class of the comparators and of detectors in programs.
#include <pybind11/stl.h>

#include <memory>
#include <mutex>

#include "tools/app/run.h"
#include "tools/bench/timed.h"
#include "tools/python/frame.h"
#include "tools/python/guard.h"
#include "tools/python/type.h"

namespace lcs::python {
namespace {

class Detector {
 public:
  Detector(const Scenario& scenario, const app::DetectorChoice& choice)
      : spec_(app::spec_of(choice)),
        scenario_(scenario.full),
        camera_(bench::intrinsics(scenario.camera)) {
    warn(comparators::apply_preset(spec_, scenario_));
    const py::gil_scoped_release others_may_run;
    const OneThread one_thread;
    detector_ = comparators::make(
        spec_, {.camera = camera_, .scenario = scenario_, .on_wait = check_signals});
  }

  std::shared_ptr<Result> step(const Frame& frame) {
    const py::gil_scoped_release others_may_run;
    const std::lock_guard lock(mutex_);
    const OneThread one_thread;
    auto result = std::make_shared<Result>();
    result->detector = {spec_.name, spec_.detector.layered, detector_->gives_circles()};
    result->step_time = detector_->step_time();
    result->wants_signatures = detector_->wants_signatures();
    const recording::FrameRecord& record = frame.seen.record;
    const std::vector<Signature> none;
    result->said = bench::timed(result->step_ms, [&]() -> const FrameResult& {
      return detector_->step({frame.seen.image, frame.seen.grey, record.corners_px, record.motion,
                              result->wants_signatures ? record.signatures : none, record.index,
                              record.t_ns});
    });
    result->masks = detector_->masks();
    return result;
  }

  std::vector<std::string> finish() {
    const py::gil_scoped_release others_may_run;
    const std::lock_guard lock(mutex_);
    detector_->finish();
    return detector_->remarks();
  }

  const std::string& name() const { return spec_.name; }

 private:
  comparators::DetectorSpec spec_;
  scenario::Scenario scenario_;  ///< with the detector's preset applied
  Intrinsics camera_;
  std::unique_ptr<bench::Detector> detector_;
  std::mutex mutex_;
};

}  // namespace

void bind_detector(py::module_& module) {
  class_of<Detector>(
      module, "Detector",
      R"(A detector of the bench: lcs, lcs:lab, lcs:cars, klt, dis (tools/comparators/README.md), or a
program of yours (tools/comparators/PROTOCOL.md). It says the same as by lcs run.)")
      .def(py::init([](const Scenario& scenario, const std::string& name,
                       const std::string& command, double timeout) {
             return std::make_unique<Detector>(scenario,
                                               app::DetectorChoice{name, command, timeout, ""});
           }),
           py::arg("scenario"), py::arg("name") = "", py::kw_only(), py::arg("command") = "",
           py::arg("timeout") = app::DetectorChoice{}.timeout_s,
           R"(name: of the detector; lcs if not given. With command: its name in results.
command: starts the program, as 'python3 mine.py'. timeout: for each of its answers, s.
Raises ValueError for an unknown name, Error for a program that does not start.)")
      .def(
          "step", [](Detector& detector, const Frame& frame) { return detector.step(frame); },
          py::arg("frame"),
          "Processes the next frame of a scenario with the same camera; give all frames in order.\n"
          "Raises Error for a program that ends or answers wrongly.")
      .def(
          "finish", [](Detector& detector) { return detector.finish(); },
          "Ends the program after the last frame. Returns remarks, a line each.")
      .def_property_readonly("name", [](const Detector& detector) { return detector.name(); });
  module.def(
      "detectors",
      [] {
        py::dict names;
        for (const comparators::DetectorKind& each : comparators::detectors()) {
          names[py::str(std::string(each.name))] = std::string(each.purpose);
        }
        return names;
      },
      "The names of the bench's detectors, with a line about each.");
}

}  // namespace lcs::python
