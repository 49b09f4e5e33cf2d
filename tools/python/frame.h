/// \file
/// The frames of a scenario, one at a time: the bench's own loop up to the detector's step;
/// and a detector's result for a frame.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <thread>

#include "filter/types/frame_result.h"
#include "sim/simulation.h"
#include "tools/bench/bench.h"
#include "tools/python/scenario.h"
#include "tools/recording/recording.h"

namespace lcs::python {

/// Data shared by all frames of a run.
struct Run {
  std::shared_ptr<const Scenario> scenario;
  recording::RunInfo info;  ///< with the warnings up to now
};

/// A frame's sensor data and truth. Immutable, because NumPy arrays are views of it.
struct Frame : std::enable_shared_from_this<Frame> {
  std::shared_ptr<const Run> run;
  bench::InputFrame seen;
  std::optional<sim::Observation> observation;  ///< absent for a recorded frame
};

/// The truth of a frame.
struct Truth {
  std::shared_ptr<const Frame> frame;
};

/// Usable only in the thread that made it, because the world's GL context belongs to that thread.
class Simulation {
 public:
  /// \throws the exceptions of `sim::Simulation` and `replay::Playback`.
  explicit Simulation(std::shared_ptr<const Scenario> scenario);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// \return the next frame; null after the last frame or a failed one.
  /// \throws as `bench::next_input_frame`; std::runtime_error in another thread;
  /// py::error_already_set after a
  ///   signal, from which the simulation can continue.
  std::shared_ptr<Frame> next();

  const Run& run() const { return *run_; }
  const bench::FrameSource* source() const { return source_.get(); }

 private:
  void require_own_thread() const;

  std::shared_ptr<Run> run_;
  bench::CornerFinder corners_;
  std::unique_ptr<sim::Simulation> simulation_;  ///< null for recorded frames
  std::unique_ptr<bench::FrameSource> source_;   ///< null after the last frame
  bench::SimulatedFrames* simulated_ = nullptr;  ///< `source_`, if it simulates
  std::thread::id thread_ = std::this_thread::get_id();
};

/// A detector's result for one frame. Immutable, because NumPy arrays are views of it.
struct Result {
  FrameResult said;
  double step_ms = 0;  ///< duration of the detector's step
  recording::DetectorInfo detector = {};
  double recording::FrameTimes::*step_time = &recording::FrameTimes::filter_ms;  ///< null: none
  bool wants_signatures = true;
  recording::SquareMasks masks = {};
};

}  // namespace lcs::python
