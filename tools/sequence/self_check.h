/// \file
/// Truth that agrees with itself: what is about to be written of a frame is held against what is
/// known of it in other ways. A disagreement is a fault of the simulator or of a writer, and ends
/// the generation.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <stdexcept>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sequence {

class TruthError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How well two accounts of a thing agree, over what was compared.
struct Agreement {
  double worst = 0;
  std::int64_t compared = 0;

  void add(double difference) {
    worst = difference > worst ? difference : worst;
    ++compared;
  }
  void add(const Agreement& other) {
    worst = other.worst > worst ? other.worst : worst;
    compared += other.compared;
  }
};

/// Two ways from a pixel to where its surface goes and back: there by the flow as the file has it,
/// back by the depth that was rendered of the next frame, the poses, and the motion of the body
/// that is seen there. On every fourth pixel of every fourth row that is marked as seen, where the
/// depth round its goal is that of one flat surface, so that it can be told between pixels. \return
/// distances between where one began and where one is again, px. \throws TruthError beyond 0.05 px.
Agreement check_flow(const sim::Pinhole& camera, const sim::Observation& now,
                     const sim::Observation& next, const cv::Mat2f& motion_px,
                     const cv::Mat1b& seen);

/// Boxes against masks: each object's box and number of pixels as they are in the mask, and every
/// pixel of the mask is some object's. \param mask ids of objects; those over `count` are none.
/// \throws TruthError
void check_masks(int frame, const cv::Mat1b& mask, std::span<const sim::ObjectTruth> objects,
                 int count);

/// The IMU's readings less their bias, integrated over the frame, against the poses: as shares of
/// what noise (six standard deviations) and the time between readings (half of it, times all
/// changes of the signal) allow for. Not over gaps. \throws TruthError beyond 1.
Agreement check_imu(const scenario::Imu& imu, double gravity_mps2, const sim::Observation& frame);

/// Times on their grid, in order, and readings between the last frame and this one.
/// \throws TruthError
void check_times(const scenario::Scenario& scenario, const sim::Observation& frame);

}  // namespace lcs::sequence
