/// \file
/// The frames of a scenario, one at a time: the bench's own loop up to where a detector speaks.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <thread>

#include "sim/simulation.h"
#include "tools/bench/bench.h"
#include "tools/python/scenario.h"

namespace lcs::python {

/// What all frames of a run have in common.
struct Run {
  std::shared_ptr<const Scenario> scenario;
  bench::Recording recording;  ///< without frames; its warnings are those until now
};

/// What was seen and what is true. Never changed once it is made, so that arrays may look at it.
struct Frame : std::enable_shared_from_this<Frame> {
  std::shared_ptr<const Run> run;
  bench::SeenFrame seen;
  std::optional<sim::Observation> observation;  ///< none of a recorded frame
};

/// What is true of a frame.
struct Truth {
  std::shared_ptr<const Frame> frame;
};

/// To be used by the thread that made it, as the world's GL context is.
class Simulation {
 public:
  /// \throws as `sim::Simulation` and `replay::Playback`.
  explicit Simulation(std::shared_ptr<const Scenario> scenario);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// None after the last frame, and after one that failed. \throws as `bench::see`;
  /// std::runtime_error in another thread, py::error_already_set for a signal, after which it may
  /// go on.
  std::shared_ptr<Frame> next();

  const Run& run() const { return *run_; }
  const bench::FrameSource* source() const { return source_.get(); }

 private:
  void require_own_thread() const;

  std::shared_ptr<Run> run_;
  FastDetector detector_;
  std::unique_ptr<sim::Simulation> simulation_;  ///< null: the frames are recorded
  std::unique_ptr<bench::FrameSource> source_;   ///< null: it is over
  bench::SimulatedFrames* simulated_ = nullptr;  ///< the same, if there is a simulation
  std::thread::id thread_ = std::this_thread::get_id();
};

void bind_frame(pybind11::module_& module);

}  // namespace lcs::python
