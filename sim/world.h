/// \file
/// The physics of a run, without any picture: rover, actors and what else moves, and the readings
/// of IMU and odometry. Needs no GL.
///
/// Events (frames, readings, phases of the ego) fall on exact times k / rate; the steps between two
/// of them are equal and at most 2 ms long. Readings at an event are of exactly that time: MuJoCo's
/// derived quantities are computed anew there.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/actor.h"
#include "sim/imu_noise.h"
#include "sim/model.h"
#include "sim/rover.h"
#include "sim/scene_builder.h"
#include "sim/simulation.h"
#include "sim/watch.h"

namespace lcs::sim {

/// Time of event k of something that happens `rate_hz` times a second, from 0.
std::int64_t event_time_ns(std::int64_t k, double rate_hz);

/// What becomes of a world in which something starts inside of something else.
enum class WrongStart {
  refused,  ///< with scenario::Error
  told,     ///< by `World::wrong_at_start`, as a preview needs it
};

class World {
 public:
  /// Stands at t = 0 afterwards.
  /// \throws scenario::Error, also where the rover starts inside of anything, an actor inside of an
  ///   object, or a wheeled rover where nothing holds it; PhysicsError
  explicit World(const scenario::Scenario& scenario, WrongStart wrong_start = WrongStart::refused);

  /// Moves on to a time, and appends the readings after the last time up to and including this one.
  /// The very first call, with 0, gives those at 0.
  /// \param imu_truth is given what is true at each reading of the IMU, if there is one.
  /// \throws PhysicsError
  void advance_to(std::int64_t t_ns, std::vector<ImuSample>& imu,
                  std::vector<OdometrySample>& odometry,
                  std::vector<ImuTruth>* imu_truth = nullptr);

  Model& model() { return model_; }
  const Model& model() const { return model_; }
  int camera_id() const { return camera_; }
  double gravity_mps2() const { return gravity_mps2_; }

  /// What the scenario or its scene states; none if neither does.
  const std::optional<scenario::Origin>& origin() const { return origin_; }

  const std::vector<Object>& objects() const { return objects_; }
  /// Body of an object; index 0 is the world.
  int body_of(int object) const { return object_bodies_.at(static_cast<std::size_t>(object)); }
  /// What FrameTruth::object says of a geom.
  int object_of_geom(int geom) const { return object_of_geom_[static_cast<std::size_t>(geom)]; }

  /// The warnings until now, or until the last frame.
  const Warnings& warnings() const { return watch_->warnings(); }
  /// What starts inside of what: a line each, worded as in the error.
  const std::vector<std::string>& wrong_at_start() const { return wrong_at_start_; }

  /// The bytes of MJCF, with rover and actors where they are now, or of MuJoCo's binary. To be
  /// called at t = 0; it changes the model, which must be the one that was made last in this
  /// process. \throws MujocoError; std::system_error without memory for them.
  std::string saved(bool as_mjcf);

  Snapshot snapshot() const;
  Pose T_WB() const;
  Pose T_WS() const;
  Eigen::Vector3d v_WB_mps() const;
  Eigen::Vector3d v_WS_mps() const;
  Eigen::Vector3d v_WC_mps() const;
  Eigen::Vector3d w_C_radps() const;

 private:
  struct MovingActor {
    int mocap = 0;
    double height_m = 0;                                          ///< of the body's origin
    Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();  ///< attitude at heading 0
    PlanarPose home;
    scenario::Trajectory trajectory;
    Trigger trigger;
  };

  World(const scenario::Scenario& scenario, const ComposedScene& composed, WrongStart wrong_start);
  void set_options(const ComposedScene& composed);
  void find_objects(const ComposedScene& composed);
  void find_actors(const ComposedScene& composed);
  void begin_watch(const ComposedScene& composed, WrongStart wrong_start);
  void place(const MovingActor& actor, const PlanarPose& pose);
  void move_actors();
  void forward();
  void step_to(std::int64_t t_ns);
  template <typename Action>
  void guarded(Action action) const;
  std::int64_t next_event_ns(std::int64_t until_ns) const;
  void read_sensors(std::vector<ImuSample>& imu, std::vector<OdometrySample>& odometry,
                    std::vector<ImuTruth>* imu_truth);

  scenario::Scenario scenario_;
  Model model_;
  std::optional<scenario::Origin> origin_;
  std::unique_ptr<Rover> rover_;
  std::vector<MovingActor> actors_;
  std::vector<Object> objects_;
  std::vector<int> object_bodies_;
  std::vector<int> object_of_geom_;
  std::unique_ptr<Watch> watch_;
  std::vector<std::string> wrong_at_start_;
  ImuNoiseModel imu_noise_;
  OdometryNoiseModel odometry_noise_;
  int camera_, base_, imu_site_, accelerometer_, gyro_;
  double gravity_mps2_ = 0;
  std::int64_t t_ns_ = 0;
  std::int64_t imu_count_ = 0;  ///< readings given out
  std::int64_t odometry_count_ = 0;
};

}  // namespace lcs::sim
