#include "sim/drive.h"

#include <Eigen/Geometry>

#include "sim/world/passage.h"

namespace lcs::sim {

Drive drive(const scenario::Scenario& scenario) {
  World world(scenario);
  Drive result{calibrate(world, scenario.camera), {}};
  Passage passage(world, scenario);
  for (int k = 0; k < scenario.frames; ++k) {
    Observation& frame = result.frames.emplace_back();
    FrameState& now = passage.frame();
    frame.truth.now = std::move(now.now);
    frame.truth.v_WC_mps = now.v_WC_mps;
    frame.truth.w_C_radps = now.w_C_radps;
    passage.advance(frame);
    frame.imu_truth.clear();
    frame.truth.next = passage.frame().now;
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
  c.time_offset_s = camera.time_offset_s + camera.told.time_offset_error_s;
  c.gravity_mps2 = world.gravity_mps2();
  c.on_ground = world.is_on_ground();
  return c;
}

}  // namespace lcs::sim
