/// \file
/// Consistency checks of the truth: compares each frame's data, before it is written, with
/// independent sources. A disagreement is a fault of the simulator or of a writer, and ends the
/// generation.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <stdexcept>

#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tools/sequence/true_flow.h"

namespace lcs::sequence {

class TruthError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The agreement of two sources, over all comparisons.
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

/// Follows the flow in its file encoding from a pixel to the next frame, and returns to this frame
/// by the depth rendered there, the poses and the motion of the body there. It checks the seen
/// pixels of every fourth row and column, if the surface round the goal is flat, so that its depth
/// can be interpolated. \return distances between start and end, px. \throws TruthError beyond
/// 0.05 px.
Agreement check_flow(const sim::Optics& camera, const sim::Observation& now,
                     const sim::Observation& next, const cv::Mat2f& motion_px,
                     const cv::Mat1b& seen);

/// Compares the picture with the flow: a pixel must find its grey level again at the goal of its
/// flow, within the levels of the four pixels round the goal and their neighbours. Compares the
/// pictures before lens and sensor, at the pixels inside a geom that are seen again and whose goal
/// lies within the same geom. A change of brightness that a whole block of 16 x 16 pixels shares is
/// light, and is subtracted. \return shares of the compared pixels of a block that disagree.
/// \throws TruthError for a block in which too many do: something is drawn there that depth, masks
/// and motion do not have.
Agreement check_picture(const sim::Observation& now, const sim::Observation& next,
                        const TrueFlow& flow);

/// Compares the picture before the lens with the mask: for each object with a long outline, the
/// contrast across its outline in the mask must not be much smaller than across the same outline
/// displaced by up to 3 px. \return the largest displaced contrast over that in place, for each
/// object. \throws TruthError for an object whose mask is displaced.
Agreement check_outlines(const sim::Observation& frame, const cv::Mat1w& mask);

/// Compares boxes with masks: each object's box and pixel count must match the mask, and each
/// object in the mask must have a box. \param mask ids of objects; ids over `count` are ignored.
/// \throws TruthError
void check_masks(int frame, const cv::Mat1w& mask, std::span<const sim::ObjectTruth> objects,
                 int count);

/// Integrates the IMU's readings less their bias over the frame, and compares them with the poses.
/// \return differences as shares of the limit: noise (six standard deviations) plus half a reading
/// period times all signal changes. Skips gaps. \throws TruthError beyond 1.
Agreement check_imu(const scenario::Imu& imu, double gravity_mps2, const sim::Observation& frame);

/// Checks that times are on their grid and in order, and readings between the last and this frame.
/// \throws TruthError
void check_times(const scenario::Scenario& scenario, const sim::Observation& frame);

}  // namespace lcs::sequence
