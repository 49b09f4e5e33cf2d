#include "sim/world/rover.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "sim/scene/ground.h"
#include "sim/scene/scene_builder.h"
#include "sim/world/path.h"
#include "sim/world/route.h"

namespace lcs::sim {
namespace {

using scenario::EgoPhase;

/// Indices of a rover joint into qpos and qvel.
struct Joint {
  int qpos, qvel;

  Joint(const Model& model, const char* name) {
    const int id = model.id(mjOBJ_JOINT, std::string(kEgoPrefix) + name);
    qpos = model.m().jnt_qposadr[id];
    qvel = model.m().jnt_dofadr[id];
  }
};

int actuator(const Model& model, const char* name) {
  return model.id(mjOBJ_ACTUATOR, std::string(kEgoPrefix) + name);
}

/// Sets the rate of a joint with a velocity actuator, whose own rate is larger by its gear.
void command_rate(Model& model, int actuator, double rate) {
  model.d().ctrl[actuator] = model.m().actuator_gear[6 * actuator] * rate;
}

/// Two slides along W's x and y and a hinge about z, each with a stiff velocity actuator.
class HolonomicRover : public Rover {
 public:
  HolonomicRover(const scenario::Ego& ego, const Model& model)
      : ego_(ego),
        command_(ego.phases),
        route_(ego.waypoints.empty() ? std::nullopt : std::optional<Route>(ego)),
        joints_{Joint(model, "x"), Joint(model, "y"), Joint(model, "yaw")},
        actuators_{actuator(model, "x"), actuator(model, "y"), actuator(model, "yaw")} {}

  void start(Model& model) override {
    mjData& d = model.d();
    const std::array<double, 3> position = {ego_.start_m.x(), ego_.start_m.y(), ego_.heading_rad};
    for (std::size_t i = 0; i < 3; ++i) d.qpos[joints_[i].qpos] = position[i];
    const std::array<double, 3> velocity = joint_rates(model, 0);
    for (std::size_t i = 0; i < 3; ++i) d.qvel[joints_[i].qvel] = velocity[i];
  }

  PlanarVelocity command(Model& model, std::int64_t t_ns) override {
    const std::array<double, 3> velocity = joint_rates(model, t_ns);
    for (std::size_t i = 0; i < 3; ++i) command_rate(model, actuators_[i], velocity[i]);
    return in_rover(model, velocity);
  }

  PlanarVelocity odometry(const Model& model) const override {
    const double* rates = model.d().qvel;
    return in_rover(model,
                    {rates[joints_[0].qvel], rates[joints_[1].qvel], rates[joints_[2].qvel]});
  }

 private:
  /// \param rates of the joints.
  PlanarVelocity in_rover(const Model& model, const std::array<double, 3>& rates) const {
    const Eigen::Rotation2Dd R_BW(-model.d().qpos[joints_[2].qpos]);
    return {R_BW * Eigen::Vector2d(rates[0], rates[1]), rates[2]};
  }

  /// Rates of the joints: x and y in W, and yaw.
  std::array<double, 3> joint_rates(const Model& model, std::int64_t t_ns) {
    if (route_) {
      const Route::Motion motion = route_->at(1e-9 * static_cast<double>(t_ns));
      return {motion.velocity_W_mps.x(), motion.velocity_W_mps.y(), motion.yaw_rate_radps};
    }
    const PlanarVelocity v = command_.at(t_ns);
    const Eigen::Vector2d v_W = Eigen::Rotation2Dd(model.d().qpos[joints_[2].qpos]) * v.linear_mps;
    return {v_W.x(), v_W.y(), v.yaw_rate_radps};
  }

  scenario::Ego ego_;
  SmoothCommand command_;
  std::optional<Route> route_;  ///< replaces the command if the ego has waypoints
  std::array<Joint, 3> joints_;
  std::array<int, 3> actuators_;
};

/// Two driven wheels and two casters, with contacts.
class WheeledRover : public Rover {
 public:
  WheeledRover(const scenario::Scenario& scenario, const Model& model)
      : ego_(scenario.ego),
        sunk_m_(kSunk_m + (scenario.ground ? kHighestGround * scenario.ground->roughness_m : 0)),
        scene_{scenario.scene.string(), 0},
        command_(scenario.ego.phases),
        base_(model, "base") {
    check(scenario);
    const mjModel& m = model.m();
    const Pose T_BW = model.body_pose(model.id(mjOBJ_BODY, kEgoBody)).inverse();
    std::array<double, 2> y_m{}, count{};  // left, right
    for (int i = 0; i < m.nu; ++i) {
      const std::string_view name = model.name(mjOBJ_ACTUATOR, i);
      const std::string prefix = kEgoPrefix;
      const bool is_right = name.starts_with(prefix + "right");
      if (!is_right && !name.starts_with(prefix + "left")) continue;
      const int joint = m.actuator_trnid[2 * i];
      wheels_.push_back({i, m.jnt_dofadr[joint], is_right});
      const int body = m.jnt_bodyid[joint];
      int geom = m.body_geomadr[body];
      while (!is_round(m.geom_type[geom])) ++geom;
      radius_m_ = m.geom_size[3 * geom];
      y_m[is_right] += (T_BW * model.body_pose(body).p).y();
      ++count[is_right];
    }
    track_m_ = y_m[0] / count[0] - y_m[1] / count[1];
  }

  void start(Model& model) override {
    mjModel& m = model.m();
    mjData& d = model.d();
    const Footing under = footing(model);
    place(d, under.height_m + kDrop_m);
    std::fill_n(d.ctrl, m.nu, 0.0);
    const int steps = static_cast<int>(std::ceil(kSettling_s / m.opt.timestep));
    call_mujoco([&] {
      for (int i = 0; i < steps; ++i) mj_step(&m, &d);
    });

    if (d.qpos[base_.qpos + 2] < under.height_m - sunk_m_) refuse_to_fall(model, under.geom);
    // settled height, roll and pitch, but the start position and heading, already rolling
    place(d, d.qpos[base_.qpos + 2]);
    const PlanarVelocity v = command_.at(0);
    const Eigen::Vector2d v_W = Eigen::Rotation2Dd(ego_.heading_rad) * v.linear_mps;
    std::fill_n(d.qvel + base_.qvel, 6, 0.0);
    d.qvel[base_.qvel] = v_W.x();
    d.qvel[base_.qvel + 1] = v_W.y();
    d.qvel[base_.qvel + 5] = v.yaw_rate_radps;
    for (const Wheel& wheel : wheels_) d.qvel[wheel.qvel] = rate_of(wheel, v);
  }

  PlanarVelocity command(Model& model, std::int64_t t_ns) override {
    const PlanarVelocity v = command_.at(t_ns);
    for (const Wheel& wheel : wheels_) command_rate(model, wheel.actuator, rate_of(wheel, v));
    return v;
  }

  PlanarVelocity odometry(const Model& model) const override {
    std::array<double, 2> sum{}, count{};  // left, right
    for (const Wheel& wheel : wheels_) {
      sum[wheel.is_right] += model.d().qvel[wheel.qvel];
      ++count[wheel.is_right];
    }
    const double left = sum[0] / count[0], right = sum[1] / count[1];
    return {{radius_m_ * (left + right) / 2, 0}, radius_m_ * (right - left) / track_m_};
  }

 private:
  struct Wheel {
    int actuator, qvel;
    bool is_right;
  };
  static constexpr double kDrop_m = 0.01;
  static constexpr double kAbove_m = 1.5;  // below a ceiling, above rough ground
  static constexpr double kSettling_s = 1.0;
  static constexpr double kSunk_m = 0.1;  // the wheel radius; between bumps their height is added

  static void check(const scenario::Scenario& scenario) {
    if (!scenario.ego.waypoints.empty()) {
      throw input::Error(scenario.ego.source,
                         "a wheeled rover slips, and cannot be at ego.waypoints at their times; "
                         "make the drive holonomic, or give start, heading, speed and phases");
    }
    for (const EgoPhase& phase : scenario.ego.phases) {
      constexpr double kSideways = 1e-6;
      if (std::abs(std::sin(phase.direction_rad)) > kSideways) {
        throw input::Error({scenario.file.string(), 0},
                           "a wheeled rover cannot drive sideways: the ego's direction at {} s is "
                           "{:g} deg; make it 0 or 180 deg, or the drive holonomic",
                           phase.at_s, phase.direction_rad * 180 / std::numbers::pi);
      }
    }
  }

  /// The surface below the start; height 0 if there is none (geom -1).
  struct Footing {
    double height_m;
    int geom;
  };
  Footing footing(Model& model) const {
    mjData& d = model.d();
    place(d, 2 * kAbove_m);  // out of the ray
    call_mujoco([&] { mj_kinematics(&model.m(), &d); });
    const std::array<double, 3> from = {ego_.start_m.x(), ego_.start_m.y(), kAbove_m};
    const std::array<double, 3> down = {0, 0, -1};
    int geom = -1;
    const double distance = mj::ray(model.m(), d, from.data(), down.data(), -1, geom);
    return {geom < 0 ? 0.0 : kAbove_m - distance, geom};
  }

  [[noreturn]] void refuse_to_fall(const Model& model, int geom) const {
    const mjModel& m = model.m();
    const std::string start =
        fmt::format("ego.start ({:g}, {:g}) m", ego_.start_m.x(), ego_.start_m.y());
    const std::string_view name = geom < 0 ? "" : model.name(mjOBJ_GEOM, geom);
    throw input::Error(
        scene_,
        geom < 0 ? fmt::format("nothing is under {}, so that a wheeled rover falls there; put a "
                               "floor under it, or make ego.drive holonomic",
                               start)
                 : fmt::format(
                       "the geom{} under {} has contype {} and conaffinity {}, so that a wheeled "
                       "rover falls through it; give it contype=\"1\" and conaffinity=\"1\" (and "
                       "no <flag contact=\"disable\"/>), or make ego.drive holonomic",
                       name.empty() ? "" : fmt::format(" '{}'", name), start, m.geom_contype[geom],
                       m.geom_conaffinity[geom]));
  }

  void place(mjData& d, double z) const {
    double* q = d.qpos + base_.qpos;
    // turn to the start heading, but keep the roll and pitch of the ground
    const Eigen::Quaterniond R(q[3], q[4], q[5], q[6]);
    const Eigen::Vector3d x = R * Eigen::Vector3d::UnitX();
    const Eigen::Quaterniond turned(
        Eigen::AngleAxisd(ego_.heading_rad - std::atan2(x.y(), x.x()), Eigen::Vector3d::UnitZ()) *
        R);
    Eigen::Map<Eigen::Matrix<double, 7, 1>>(q) << ego_.start_m, z, turned.w(), turned.vec();
  }

  double rate_of(const Wheel& wheel, const PlanarVelocity& v) const {
    const double half = v.yaw_rate_radps * track_m_ / 2;
    return (v.linear_mps.x() + (wheel.is_right ? half : -half)) / radius_m_;
  }

  scenario::Ego ego_;
  double sunk_m_;  ///< below the surface under it, more than a supported rover
  input::Source scene_;
  SmoothCommand command_;
  Joint base_;
  std::vector<Wheel> wheels_;
  double track_m_ = 0;
  double radius_m_ = 0;
};

/// A camera on a path. Its pose and velocity are set anew for each step, so that they are exact at
/// events.
class CarriedCamera : public Rover {
 public:
  CarriedCamera(const scenario::Scenario& scenario, const Model& model)
      : path_(scenario.ego), base_(model, "base") {
    if (!scenario.odometry.enabled) return;
    throw input::Error(scenario.ego.source,
                       "odometry measures wheels, and a camera on ego.path has none; remove "
                       "odometry, or give the ego a drive in place of its path");
  }

  void start(Model& model) override { command(model, 0); }

  PlanarVelocity command(Model& model, std::int64_t t_ns) override {
    now_ = path_.at(1e-9 * static_cast<double>(t_ns));
    const Eigen::Quaterniond q(now_.T_WB.R);
    Eigen::Map<Eigen::Matrix<double, 7, 1>>(model.d().qpos + base_.qpos) << now_.T_WB.p, q.w(),
        q.vec();
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(model.d().qvel + base_.qvel) << now_.v_WB_mps,
        now_.w_B_radps;
    return {};
  }

  void accelerate(Model& model) override {
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(model.d().qacc + base_.qvel) << now_.a_WB_mps2,
        now_.dw_B_radps2;
  }

  PlanarVelocity odometry(const Model&) const override { return {}; }

 private:
  Path path_;
  Joint base_;
  Path::Motion now_;
};

}  // namespace

PlanarVelocity commanded_velocity(const std::vector<EgoPhase>& phases, std::int64_t t_ns) {
  const auto later = std::ranges::upper_bound(
      phases, t_ns, {}, [](const EgoPhase& p) { return std::llround(p.at_s * 1e9); });
  if (later == phases.begin()) return {};
  const EgoPhase& phase = *std::prev(later);
  const double since = 1e-9 * static_cast<double>(t_ns) - phase.at_s;
  const double speed = std::max(0.0, phase.speed_mps + phase.acceleration_mps2 * since);
  return {speed * Eigen::Vector2d(std::cos(phase.direction_rad), std::sin(phase.direction_rad)),
          phase.yaw_rate_radps};
}

SmoothCommand::SmoothCommand(std::vector<EgoPhase> phases)
    : phases_(std::move(phases)),
      max_acceleration_mps2_(kMaxAcceleration_mps2),
      now_(commanded_velocity(phases_, 0)) {
  for (const EgoPhase& phase : phases_) {
    max_acceleration_mps2_ = std::max(max_acceleration_mps2_, std::abs(phase.acceleration_mps2));
  }
}

PlanarVelocity SmoothCommand::at(std::int64_t t_ns) {
  const double dt = 1e-9 * static_cast<double>(t_ns - t_ns_);
  t_ns_ = t_ns;
  const PlanarVelocity target = commanded_velocity(phases_, t_ns);
  const Eigen::Vector2d change = target.linear_mps - now_.linear_mps;
  const double most = max_acceleration_mps2_ * dt;
  now_.linear_mps = change.norm() <= most
                        ? target.linear_mps
                        : Eigen::Vector2d(now_.linear_mps + most * change.normalized());
  const double most_yaw = kMaxYawAcceleration_radps2 * dt;
  now_.yaw_rate_radps +=
      std::clamp(target.yaw_rate_radps - now_.yaw_rate_radps, -most_yaw, most_yaw);
  return now_;
}

std::unique_ptr<Rover> make_rover(const scenario::Scenario& scenario, const Model& model) {
  if (scenario.ego.is_carried()) return std::make_unique<CarriedCamera>(scenario, model);
  if (model.has(mjOBJ_ACTUATOR, kEgoPrefix + std::string("x"))) {
    return std::make_unique<HolonomicRover>(scenario.ego, model);
  }
  return std::make_unique<WheeledRover>(scenario, model);
}

}  // namespace lcs::sim
