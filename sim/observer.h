/// \file
/// A world with its camera: yields the observations of `Simulation`, and gives access to the world.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/camera/lens_renderer.h"
#include "sim/camera/photograph.h"
#include "sim/events/event_sensor.h"
#include "sim/scene/silhouette.h"
#include "sim/simulation.h"
#include "sim/world/passage.h"

namespace lcs::sim {

/// Not movable. Use it only from the thread that constructed it: it holds the GL context.
class Observer {
 public:
  /// \throws as `Simulation`.
  Observer(const scenario::Scenario& scenario, WrongStart wrong_start);

  const scenario::Scenario& scenario() const { return scenario_; }
  const Calibration& calibration() const { return calibration_; }
  /// The world at the time of the next frame, or at the end of its exposure and readout.
  const World& world() const { return world_; }
  int next_index() const { return passage_.index(); }  ///< of the next frame
  const FrameState& frame() const { return passage_.frame(); }
  FrameReadings late_readings() const { return passage_.late_readings(); }
  std::string gl_renderer() const { return renderer_.gl_renderer(); }

  /// Renders the next frame, even beyond the scenario's number of frames. \throws PhysicsError
  Observation observe();
  /// Skips the next frame: advances to the frame after it, and keeps the readings between the two.
  /// \throws PhysicsError
  void advance();

 private:
  /// Light is linear, BGR, before lens and lamps.
  struct Drawing {
    cv::Mat3f even, light;  ///< without shadows; with those that the scenario wants
    cv::Mat1f depth_m;
    cv::Mat1i geom, shadow_edge;
  };
  Drawing draw(bool has_truth);
  Drawing draw_through_shutter(const FrameState& frame, int index);
  void visit_ways(const std::vector<const Snapshot*>& at, const Snapshot& reference,
                  const cv::Mat1f& depth_m, const cv::Mat1i& geom, const auto& on_point) const;
  double shift_px(const FrameState& frame, const cv::Mat1f& depth_m, const cv::Mat1i& geom) const;
  void sense_events(const FrameState& frame, Observation& o);
  void develop(const cv::Mat3f& light, Observation& o);
  std::vector<double> areas_px(const cv::Mat1i& object) const;
  std::vector<ObjectTruth> visible_objects(const FrameTruth& truth) const;
  void note_unseen();

  scenario::Scenario scenario_;
  World world_;
  Calibration calibration_;
  LensRenderer renderer_;
  std::vector<ConvexParts> parts_;  ///< of each index of `Snapshot::T_WO`
  Photographer photographer_;
  Passage passage_;
  std::optional<EventSensor> event_sensor_;
  /// The last frame as event pixels have it.
  struct Sensed {
    Snapshot now;
    cv::Mat1f depth_m;
    cv::Mat1i geom;
  };
  std::optional<Sensed> sensed_;
  int observed_ = 0;    ///< number of frames rendered
  std::set<int> seen_;  ///< objects with a visible pixel in any of them
};

}  // namespace lcs::sim
