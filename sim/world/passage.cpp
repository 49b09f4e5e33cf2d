#include "sim/world/passage.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sim/events/event_sensor.h"

namespace lcs::sim {
namespace {

/// Moves the readings until a time.
template <class Sample>
void take_until(std::int64_t t_ns, std::vector<Sample>& from, std::vector<Sample>& to) {
  const auto end = std::ranges::find_if(from, [&](const Sample& s) { return s.t_ns > t_ns; });
  to.assign(std::move_iterator(from.begin()), std::move_iterator(end));
  from.erase(from.begin(), end);
}

}  // namespace

Passage::Passage(World& world, const scenario::Scenario& scenario)
    : world_(world),
      rate_hz_(scenario.camera.rate_hz),
      told_later_ns_(std::llround(1e9 * scenario.camera.told.time_offset_error_s)),
      shutter_(scenario.camera),
      has_events_(scenario.events.has_value()) {
  pass_frame();
}

void Passage::pass_frame() {
  const std::int64_t frame_ns = event_time_ns(index_, rate_hz_);
  const auto reach_frame = [&] {
    advance_to(frame_ns);
    frame_.now = world_.snapshot();
    frame_.T_WB = world_.T_WB();
    frame_.v_WC_mps = world_.v_WC_mps();
    frame_.w_C_radps = world_.w_C_radps();
  };
  frame_ = {};
  bool is_reached = shutter_.is_instant();
  if (is_reached) reach_frame();
  for (const std::int64_t after_ns : shutter_.instants_ns()) {
    const std::int64_t t_ns = frame_ns + after_ns;
    if (!is_reached && after_ns >= 0) {
      reach_frame();
      is_reached = true;
    }
    if (t_ns >= 0) advance_to(t_ns);
    frame_.stages.push_back(t_ns >= 0 ? world_.stage() : world_.stage_before(t_ns));
    frame_.snapshots.push_back(t_ns >= 0 ? world_.snapshot()
                                         : world_.snapshot_of(frame_.stages.back()));
  }
  take_until(frame_ns, early_instants_, frame_.event_instants);
}

/// Instant 0 is of time 0; then there are `kEventCells` from each frame to the next.
std::int64_t Passage::event_instant_ns() const {
  if (event_instants_ == 0) return 0;
  const std::int64_t frame = (event_instants_ - 1) / kEventCells;
  const std::int64_t cells = (event_instants_ - 1) % kEventCells + 1;
  const std::int64_t from_ns = event_time_ns(frame, rate_hz_);
  return from_ns + (event_time_ns(frame + 1, rate_hz_) - from_ns) * cells / kEventCells;
}

void Passage::advance_to(std::int64_t t_ns) {
  const auto reach = [&](std::int64_t at_ns) {
    world_.advance_to(at_ns, readings_.imu, readings_.odometry, &readings_.imu_truth);
  };
  for (; has_events_ && event_instant_ns() <= t_ns; ++event_instants_) {
    reach(event_instant_ns());
    early_instants_.push_back({event_instant_ns(), world_.stage(), world_.snapshot()});
  }
  reach(t_ns);
}

void Passage::advance(FrameReadings& frame) {
  frame.index = index_;
  frame.t_ns = event_time_ns(index_, rate_hz_);
  ++index_;
  pass_frame();
  const std::int64_t until_ns = frame.t_ns + told_later_ns_;
  take_until(until_ns, readings_.imu, frame.imu);
  take_until(until_ns, readings_.odometry, frame.odometry);
  take_until(until_ns, readings_.imu_truth, frame.imu_truth);
}

FrameReadings Passage::late_readings() const {
  FrameReadings late;
  if (shutter_.is_instant() || index_ == 0) return late;
  const std::int64_t end_ns = event_time_ns(index_ - 1, rate_hz_) + shutter_.instants_ns().back();
  late = readings_;
  const auto& states = readings_.imu_truth;
  const auto last = std::ranges::find_if(states, [&](const auto& s) { return s.t_ns >= end_ns; });
  if (last == states.end()) return late;
  const auto is_later = [&](const auto& reading) { return reading.t_ns > last->t_ns; };
  std::erase_if(late.imu, is_later);
  std::erase_if(late.odometry, is_later);
  std::erase_if(late.imu_truth, is_later);
  return late;
}

}  // namespace lcs::sim
