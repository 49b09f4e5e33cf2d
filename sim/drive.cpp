#include "sim/drive.h"

#include <Eigen/Geometry>

#include "sim/world/world.h"

namespace lcs::sim {

Drive drive(const scenario::Scenario& scenario) {
  World world(scenario);
  Drive result{calibrate(world, scenario.camera), {}};
  Observation next;
  world.advance_to(0, next.imu, next.odometry);
  next.truth.now = world.snapshot();
  for (int k = 0; k < scenario.frames; ++k) {
    Observation frame = std::move(next);
    frame.index = k;
    frame.t_ns = event_time_ns(k, scenario.camera.rate_hz);
    frame.truth.v_WC_mps = world.v_WC_mps();
    frame.truth.w_C_radps = world.w_C_radps();
    next = {};
    world.advance_to(event_time_ns(k + 1, scenario.camera.rate_hz), next.imu, next.odometry);
    next.truth.now = world.snapshot();
    frame.truth.next = next.truth.now;
    result.frames.push_back(std::move(frame));
  }
  return result;
}

Calibration calibrate(const World& world, const scenario::Camera& camera) {
  const Pose T_BW = world.T_WB().inverse();
  Calibration c;
  c.optics = Optics(lens_of(camera));
  c.camera = c.optics.lens().pinhole();
  c.T_BC = T_BW * world.snapshot().T_WC;
  c.T_BC.p.z() += camera.told.height_error_m;
  c.T_BC.R = Eigen::AngleAxisd(camera.told.pitch_error_rad, Eigen::Vector3d::UnitY()) * c.T_BC.R;
  c.T_BS = T_BW * world.T_WS();
  c.T_WB_start = world.T_WB();
  c.v_WB_start_mps = world.v_WB_mps();
  c.gravity_mps2 = world.gravity_mps2();
  c.on_ground = world.is_on_ground();
  return c;
}

}  // namespace lcs::sim
