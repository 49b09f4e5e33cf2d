/// \file
/// The physics of a run, without rendering: rover, actors and other moving bodies, and the readings
/// of IMU and odometry. Needs no GL.
///
/// Events (frames, readings, phases of the ego) have exact times k / rate; the steps between two
/// events are equal, and as long as the scene's timestep at most, and 2 ms. At each event MuJoCo's
/// derived quantities are recomputed, so that readings are of exactly that time.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/physics_error.h"
#include "sim/imu/imu.h"
#include "sim/imu/imu_noise.h"
#include "sim/scene/drawables.h"
#include "sim/scene/gait.h"
#include "sim/scene/model.h"
#include "sim/scene/scene_builder.h"
#include "sim/truth/truth.h"
#include "sim/world/actor.h"
#include "sim/world/rover.h"
#include "sim/world/watch.h"

namespace lcs::sim {

/// Time of event k, counted from 0, of a process with `rate_hz` events per second.
std::int64_t event_time_ns(std::int64_t k, double rate_hz);

/// How to handle a body that starts inside another body.
enum class WrongStart {
  refused,  ///< throws input::Error
  told,     ///< `World::wrong_at_start` lists it, for previews
};

/// The poses that a picture shows: of bodies, geoms, cameras and lights, in MuJoCo's layout.
struct ScenePoses {
  std::vector<mjtNum> numbers;
};

class World {
 public:
  /// Loads the world and sets it to t = 0.
  /// \throws input::Error, also if the rover starts inside anything, an actor starts inside an
  /// object, or no ground supports a wheeled rover; PhysicsError
  explicit World(const scenario::Scenario& scenario, WrongStart wrong_start = WrongStart::refused);

  /// Advances to time `t_ns`, and appends the readings after the last time up to and including it.
  /// The first call, with 0, yields the readings at time 0.
  /// \param imu_truth if given, receives the truth at each IMU reading. \throws PhysicsError
  void advance_to(std::int64_t t_ns, std::vector<ImuSample>& imu,
                  std::vector<OdometrySample>& odometry,
                  std::vector<ImuTruth>* imu_truth = nullptr);

  Model& model() { return model_; }
  const Model& model() const { return model_; }
  int camera_id() const { return camera_; }
  double gravity_mps2() const { return gravity_mps2_; }

  /// The map origin that the scenario or its scene states; absent if neither does.
  const std::optional<scenario::Origin>& origin() const { return origin_; }

  const std::vector<Object>& objects() const { return objects_; }
  /// Body of an object; index 0 is the world. Or of a limb, by its index in `Snapshot::T_WO`.
  int body_of(int object) const { return object_bodies_.at(static_cast<std::size_t>(object)); }
  /// As `FrameTruth::limb_objects`.
  const std::vector<int>& limb_objects() const { return limb_objects_; }
  /// The value of FrameTruth::object for pixels of a geom.
  int object_of_geom(int geom) const { return object_of_geom_[static_cast<std::size_t>(geom)]; }
  /// The value of FrameTruth::carrier for pixels of a geom.
  int carrier_of_geom(int geom) const { return carrier_of_geom_[static_cast<std::size_t>(geom)]; }
  /// Whether the camera can see a geom: its group is chosen, and it is not transparent.
  bool is_drawn(int geom) const { return is_drawn_[static_cast<std::size_t>(geom)] != 0; }
  const GeomGroups& groups() const { return groups_; }

  /// The warnings until now, or until the last frame.
  const Warnings& warnings() const { return watch_->warnings(); }
  Warnings& warnings() { return watch_->warnings(); }
  /// The overlaps at the start, one line each, worded as in the error.
  const std::vector<std::string>& wrong_at_start() const { return wrong_at_start_; }

  /// The world as MJCF with rover and actors at their present poses, or as MuJoCo's binary. Call it
  /// at t = 0: it changes the model.
  /// \throws MujocoError; std::system_error if memory is short.
  std::string saved(bool as_mjcf);

  /// Whether the rover's origin stays on the ground.
  bool is_on_ground() const { return !scenario_.ego.is_carried(); }
  Snapshot snapshot() const;
  /// The poses of the last forward pass.
  ScenePoses stage();
  /// The poses at a time before 0, if rover and free bodies had moved with their present velocities
  /// from then on. Call it at t = 0.
  ScenePoses stage_before(std::int64_t t_ns);
  /// Shows poses of another time to a renderer, until poses of the present are shown or
  /// `advance_to` is called. It changes no state of the physics.
  void show(const ScenePoses& stage);
  Snapshot snapshot_of(const ScenePoses& stage);
  Pose T_WB() const { return model_.body_pose(base_); }
  Pose T_WS() const { return model_.site_pose(imu_site_); }
  Eigen::Vector3d v_WB_mps() const;
  Eigen::Vector3d v_WS_mps() const;
  Eigen::Vector3d v_WC_mps() const;
  Eigen::Vector3d w_C_radps() const;

 private:
  struct MovingJoint {
    int position, velocity;  ///< index in MuJoCo's qpos and qvel
    std::vector<scenario::JointPoint> points;
  };
  struct MovingActor {
    int body = 0;
    double height_m = 0;                                          ///< of the body's origin
    Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();  ///< attitude at heading 0
    PlanarPose home;
    scenario::Trajectory trajectory;
    Trigger trigger;
    std::string name;
    double nearest_m = std::numeric_limits<double>::infinity();  ///< to the rover, between origins
    bool has_moved = false;
    std::optional<Gait> gait = std::nullopt;
    std::vector<MovingJoint> joints = {};               ///< with any, the trajectory does not count
    Eigen::Vector2i positions{0, 0}, velocities{0, 0};  ///< [begin, end) of all joints in its body
  };

  struct Loaded {
    ComposedScene composed;
    Model model;
  };
  static Loaded load(const scenario::Scenario& scenario);
  World(const scenario::Scenario& scenario, Loaded loaded, WrongStart wrong_start);
  void set_options();
  void find_objects();
  void place_imu();
  void find_actors();
  void find_joints(MovingActor& actor, const scenario::Actor& asked);
  void find_limbs(int body);
  void begin_watch(WrongStart wrong_start);
  void note_looks(const Drawables& drawables);
  void note_load();
  void note_coplanar();
  void end_watch();
  bool place(const MovingActor& actor, double seconds);
  void move_actors();
  void forward();
  void step_to(std::int64_t t_ns);
  void guarded(const auto& action);
  std::int64_t next_event_ns(std::int64_t until_ns) const;
  ImuSample ideal_reading();
  void read_sensors(std::vector<ImuSample>& imu, std::vector<OdometrySample>& odometry,
                    std::vector<ImuTruth>* imu_truth);

  scenario::Scenario scenario_;
  ComposedScene composed_;
  Model model_;
  std::optional<scenario::Origin> origin_;
  std::unique_ptr<Rover> rover_;
  std::vector<MovingActor> actors_;
  std::vector<Object> objects_;
  std::vector<int> object_bodies_;
  std::vector<int> object_of_geom_, carrier_of_geom_;
  std::vector<int> limb_objects_;
  GeomGroups groups_{};
  std::vector<char> is_drawn_;  ///< by geom
  std::unique_ptr<Watch> watch_;
  bool is_watch_over_ = false;  ///< the last frame is past
  std::vector<std::string> wrong_at_start_;
  ImuNoiseModel imu_noise_;
  OdometryNoiseModel odometry_noise_;
  int camera_, base_, imu_site_;
  double gravity_mps2_ = 0;
  std::int64_t t_ns_ = 0;
  std::int64_t imu_count_ = 0;  ///< number of readings so far
  ImuTruth imu_truth_;          ///< at the last of them
  std::int64_t odometry_count_ = 0;
};

}  // namespace lcs::sim
