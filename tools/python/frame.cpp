#include "tools/python/frame.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <limits>
#include <map>
#include <span>
#include <utility>

#include "filter/detect/picture_noise.h"
#include "filter/ego_motion/intake.h"
#include "tools/python/arrays.h"
#include "tools/python/guard.h"
#include "tools/python/type.h"
#include "tools/recording/warnings.h"
#include "tools/replay/playback.h"

namespace lcs::python {
namespace {

// ---- Motion

/// The mean angular velocity of a rotation over `dt_s`, camera frame, rad/s; 0 unless dt_s > 0.
Eigen::Vector3d rate_of(const Eigen::Matrix3d& R_cur_prev, double dt_s) {
  if (!(dt_s > 0)) return Eigen::Vector3d::Zero();
  return bench::motion_between({.R = R_cur_prev}, {}, dt_s).w_C_radps;
}

EgoMotion motion_of(double dt, const OptionalArray& rotation, const OptionalArray& velocity,
                    const OptionalArray& angular_velocity, const OptionalArray& up,
                    std::optional<double> height, double unseen_turn, double velocity_sigma) {
  EgoMotion motion;
  motion.dt_s = dt;
  if (!rotation.is_none()) {
    motion.R_cur_prev = matrix_of<3, 3>(rotation, "rotation", "3 x 3 numbers");
  }
  constexpr const char* kVelocity = "3 numbers, m/s";
  if (!velocity.is_none()) motion.v_C_mps = matrix_of<3, 1>(velocity, "velocity", kVelocity);
  motion.w_C_radps =
      angular_velocity.is_none()
          ? rate_of(motion.R_cur_prev, dt)
          : matrix_of<3, 1>(angular_velocity, "angular_velocity", "3 numbers, rad/s");
  if (up.is_none() == height.has_value()) {
    throw py::value_error("the ground is known by up and height; give both or none");
  }
  if (height) {
    motion.ground =
        Ground{.up_C = matrix_of<3, 1>(up, "up", "3 numbers, of length 1"), .height_m = *height};
  }
  motion.unseen_turn_rad = unseen_turn;
  motion.velocity_sigma_mps = velocity_sigma;
  return motion;
}

sim::Pose pose_of(const py::object& T, const char* name) {
  const auto matrix =
      matrix_of<4, 4>(T, name, "4 x 4 numbers, which take camera coordinates to the world's");
  return {.R = matrix.topLeftCorner<3, 3>(), .p = matrix.topRightCorner<3, 1>()};
}

EgoMotion motion_between(const ArrayLike& before, const ArrayLike& now, double dt) {
  if (!(dt > 0)) throw py::value_error(fmt::format("dt is {} s; it must be above 0", dt));
  return bench::motion_between(pose_of(before, "T_WC_before"), pose_of(now, "T_WC_now"), dt);
}

bool is_usable(const EgoMotion& motion) {
  Diagnostics nobody_asks;
  const std::optional<EgoMotion> taken = Intake().take(motion, nobody_asks);
  return taken && taken->dt_s > 0;
}

void bind_motion(py::module_& module) {
  class_of<EgoMotion>(
      module, "Motion",
      "How the camera moved from the last frame to this one. Camera frame: x right, y down, z\n"
      "forward.")
      .def(
          py::init(&motion_of), py::kw_only(), py::arg("dt"), py::arg("rotation") = py::none(),
          py::arg("velocity") = py::none(), py::arg("angular_velocity") = py::none(),
          py::arg("up") = py::none(), py::arg("height") = py::none(), py::arg("unseen_turn") = 0.0,
          py::arg("velocity_sigma") = 0.0,
          R"(dt in s; rotation 3 x 3, none where not given; velocity 3, m/s, of the camera in its frame of now;
angular_velocity 3, rad/s, from the rotation where not given; up and height: the ground, see
there; unseen_turn in rad, velocity_sigma in m/s.)")
      .def_static("between", &motion_between, py::arg("T_WC_before"), py::arg("T_WC_now"),
                  py::arg("dt"), "Of two poses of the camera, 4 x 4, that are dt seconds apart.")
      .def_readonly("dt", &EgoMotion::dt_s, "Time since the last frame, s; 0 in the first one.")
      .def_property_readonly(
          "rotation", [](const EgoMotion& m) { return copy(m.R_cur_prev); },
          "3 x 3 float64: takes camera coordinates from the last frame to this one.")
      .def_property_readonly(
          "velocity", [](const EgoMotion& m) { return copy(m.v_C_mps); },
          "3 float64, m/s: mean velocity of the camera since the last frame, in its frame of now.")
      .def_property_readonly(
          "displacement", [](const EgoMotion& m) { return copy((m.v_C_mps * m.dt_s).eval()); },
          "3 float64, m: of the camera since the last frame, in its frame of now.")
      .def_property_readonly(
          "angular_velocity", [](const EgoMotion& m) { return copy(m.w_C_radps); },
          "3 float64, rad/s: mean body rate of the camera.")
      .def_readonly("unseen_turn", &EgoMotion::unseen_turn_rad,
                    "rad: standard deviation of the rotation's error while gyro readings are "
                    "missing; else 0.")
      .def_readonly("velocity_sigma", &EgoMotion::velocity_sigma_mps,
                    "m/s: standard deviation of the velocity's error; 0 if unknown.")
      .def_property_readonly(
          "up",
          [](const EgoMotion& m) {
            return m.ground ? OptionalVector(copy(m.ground->up_C)) : OptionalVector(py::none());
          },
          "3 float64: unit normal of the ground, against gravity, in the camera's frame; None if "
          "unknown.")
      .def_property_readonly(
          "height",
          [](const EgoMotion& m) {
            return m.ground ? std::optional(m.ground->height_m) : std::nullopt;
          },
          "m: of the camera above the ground; None if unknown.")
      .def_property_readonly(
          "usable", &is_usable,
          R"(Whether a filter can predict from the last frame by it. If not, the filter starts anew.
False for the first frame.)")
      .def("__repr__", [](const EgoMotion& m) {
        return fmt::format("<lcs.Motion: {} s, {:.3f} m/s, {:.3f} rad/s{}>", m.dt_s,
                           m.v_C_mps.norm(), m.w_C_radps.norm(),
                           is_usable(m) ? "" : ", not usable");
      });
}

// ---- Frame

Eigen::Matrix4d matrix_of(const sim::Pose& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.R;
  matrix.topRightCorner<3, 1>() = pose.p;
  return matrix;
}

py::array signatures(const py::object& self) {
  const auto& given = self.cast<const Frame&>().seen.record.signatures;
  return view({std::ssize(given), py::ssize_t{sizeof(SignatureBytes)}},
              reinterpret_cast<const std::uint8_t*>(given.data()), self);
}

py::array corners(const Frame& frame) {
  return table<2>(frame.seen.record.corners_px, std::identity());
}

double seconds(std::int64_t t_ns) {
  return static_cast<double>(t_ns) * 1e-9;
}

/// A row of a structured array of sensor samples.
struct ImuRow {
  double t;
  double gyro[3], accel[3];
};
struct OdometryRow {
  double t;
  double velocity[3], yaw_rate;
};

py::array imu(const Frame& frame) {
  std::vector<ImuRow> rows;
  if (frame.observation) {
    for (const sim::ImuSample& sample : frame.observation->imu) {
      const Eigen::Vector3d &w = sample.gyro_radps, &a = sample.accel_mps2;
      rows.push_back({seconds(sample.t_ns), {w.x(), w.y(), w.z()}, {a.x(), a.y(), a.z()}});
    }
  }
  return read_only(py::array_t<ImuRow>(std::ssize(rows), rows.data()));
}

py::array odometry(const Frame& frame) {
  std::vector<OdometryRow> rows;
  if (frame.observation) {
    for (const sim::OdometrySample& sample : frame.observation->odometry) {
      const Eigen::Vector3d& v = sample.velocity_mps;
      rows.push_back({seconds(sample.t_ns),
                      {v.x(), v.y(), v.z()},
                      sample.yaw_rate_radps.value_or(std::numeric_limits<double>::quiet_NaN())});
    }
  }
  return read_only(py::array_t<OdometryRow>(std::ssize(rows), rows.data()));
}

void bind_seen(py::module_& module) {
  class_of<Frame, std::shared_ptr<Frame>>(
      module, "Frame",
      R"(The data of the sensors, and apart from them the truth. Arrays are read-only and keep their values
when the simulation continues; arrays of pictures are views.)")
      .def_property_readonly(
          "index", [](const Frame& f) { return f.seen.record.index; }, "From 0.")
      .def_property_readonly(
          "time", [](const Frame& f) { return seconds(f.seen.record.t_ns); }, "s")
      .def_property_readonly(
          "time_ns", [](const Frame& f) { return f.seen.record.t_ns; }, "ns")
      .def_property_readonly(
          "picture",
          [](const py::object& self) { return view(self.cast<const Frame&>().seen.image, self); },
          "H x W x 3 uint8, blue, green, red, as OpenCV has it; picture[..., ::-1] is RGB.")
      .def_property_readonly(
          "grey",
          [](const py::object& self) { return view(self.cast<const Frame&>().seen.grey, self); },
          "H x W uint8: the grey picture in which the corners were found.")
      .def_property_readonly(
          "noise", [](const Frame& f) { return noise_levels(f.seen.grey); },
          "Standard deviation of the noise of grey, in grey levels; None if all flat parts are "
          "black or white.")
      .def_property_readonly("corners", &corners,
                             "N x 2 float64, x and y in pixels: the corners that FAST found.")
      .def_property_readonly("signatures", &signatures,
                             "N x 32 uint8: the appearance of each corner, by the bits of ORB.")
      .def_property_readonly(
          "motion", [](const Frame& f) { return f.seen.record.motion; },
          R"(Motion since the last frame as detectors get it: by IMU and odometry with their errors, or as the
scenario's ego_motion says.)")
      .def_property_readonly(
          "imu", &imu,
          "Readings since the last frame, fields t (s), gyro (3, rad/s), accel (3, m/s^2), in the\n"
          "IMU's frame; empty for a recorded frame.")
      .def_property_readonly(
          "odometry", &odometry,
          R"(Readings since the last frame, fields t (s), velocity (3, m/s, of the rover in its frame: x forward,
z up), yaw_rate (rad/s, by the wheels; nan if they do not measure it).)")
      .def_property_readonly(
          "truth", [](const Frame& f) { return Truth{f.shared_from_this()}; },
          "The truth of the frame; detectors must not use it.")
      .def("__repr__", [](const Frame& f) {
        return fmt::format("<lcs.Frame {} of {}: {} corners at {} s>", f.seen.record.index,
                           f.run->info.scenario, f.seen.record.corners_px.size(),
                           seconds(f.seen.record.t_ns));
      });
}

// ---- Truth

const sim::Observation& observation_of(const Truth& truth) {
  if (truth.frame->observation) return *truth.frame->observation;
  throw py::value_error(
      "the truth of a recorded frame is known only by its labels; give a scenario with a scene");
}

py::array truth_of_points(const Truth& truth, const ArrayLike& points) {
  const sim::Observation& observation = observation_of(truth);
  const Scenario& scenario = *truth.frame->run->scenario;
  return rows(sim::label_corners(scenario.camera, observation.truth, points_of(points, "points"),
                                 scenario.full.truth_min_depth_m));
}

py::array object_poses(const Truth& truth) {
  const sim::FrameTruth& exact = observation_of(truth).truth;
  const std::span poses(exact.now.T_WO.begin(),
                        exact.now.T_WO.end() - std::ssize(exact.limb_objects));
  return table<4, 4>(poses, [](const sim::Pose& pose) { return matrix_of(pose); });
}

py::array object_boxes(const Truth& truth) {
  return table<4>(truth.frame->seen.record.object_truth, [](const sim::ObjectTruth& object) {
    return Eigen::Vector4d(object.left, object.top, object.right, object.bottom);
  });
}

void bind_truth(py::module_& module) {
  class_of<Truth>(
      module, "Truth",
      R"(The truth of a frame, as tools/scoring/SCORING.md defines it. A recorded frame has only labels;
its motion, depth, object_ids and poses raise ValueError.)")
      .def_property_readonly(
          "motion",
          [](const Truth& t) {
            observation_of(t);
            return t.frame->seen.record.true_motion;
          },
          "Motion since the last frame by the exact poses.")
      .def_property_readonly(
          "labels",
          [](const Truth& t) {
            return py::array(rows(t.frame->seen.record.corner_truth)["label"]);
          },
          "N uint8, a Label for each of the frame's corners.")
      .def_property_readonly(
          "corners", [](const Truth& t) { return rows(t.frame->seen.record.corner_truth); },
          R"(A row for each of the frame's corners: label, radial, outline, object (its id; 0: the fixed world,
-1: none), depth_m, motion_x, motion_y (px until the next frame), static_motion_x,
static_motion_y (px: the same if the point were fixed).)")
      .def("of", &truth_of_points, py::arg("points"),
           "The rows of `corners` for other points, N x 2 in pixels, such as corners of your own "
           "detector.")
      .def_property_readonly(
          "objects", [](const Truth& t) { return rows(t.frame->seen.record.object_truth); },
          R"(A row for each visible object: object (its id), left, top, right, bottom (pixel edges of its
visible part), visible_px, visible_fraction, moving.)")
      .def_property_readonly("boxes", &object_boxes,
                             "M x 4 float64: left, top, right, bottom of `objects`, pixel edges.")
      .def_property_readonly(
          "names",
          [](const Truth& t) {
            std::map<int, std::string> names;
            for (const sim::Object& object : t.frame->run->info.objects)
              names[object.id] = object.name;
            return names;
          },
          "The names of all objects by id.")
      .def_property_readonly(
          "depth",
          [](const py::object& self) {
            return view(observation_of(self.cast<const Truth&>()).truth.depth_m, self);
          },
          "H x W float32: z-depth, m; inf where there is sky.")
      .def_property_readonly(
          "object_ids",
          [](const py::object& self) {
            return view(observation_of(self.cast<const Truth&>()).truth.object, self);
          },
          "H x W int32: id of the object that a pixel shows; 0 the fixed setting, -1 sky and the "
          "rover.")
      .def_property_readonly(
          "T_WC", [](const Truth& t) { return copy(matrix_of(observation_of(t).truth.now.T_WC)); },
          "4 x 4 float64: takes camera coordinates to the world's (z up), m.")
      .def_property_readonly("T_WO", &object_poses,
                             "K x 4 x 4 float64: takes coordinates of the object with that id to "
                             "the world's; 0 is the world.");
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const Scenario> scenario)
    : run_(std::make_shared<Run>()), corners_(scenario->full) {
  const py::gil_scoped_release others_may_run;
  require_no_fork();
  const OneThread one_thread;
  if (scenario->asked.recording) {
    auto playback = std::make_unique<replay::Playback>(scenario->asked);
    run_->info = playback->info();
    source_ = std::move(playback);
  } else {
    simulation_ = std::make_unique<sim::Simulation>(scenario->full);
    run_->info = bench::run_info(scenario->full, *simulation_);
    auto frames = std::make_unique<bench::SimulatedFrames>(scenario->full, *simulation_);
    simulated_ = frames.get();
    source_ = std::move(frames);
  }
  run_->info.warnings = source_->warnings();
  run_->scenario = std::move(scenario);
}

Simulation::~Simulation() {
  // GL may be busy in another thread, and does not work in a fork: leak the memory then.
  if (std::this_thread::get_id() == thread_ && !is_fork()) return;
  static_cast<void>(source_.release());
  static_cast<void>(simulation_.release());
}

void Simulation::require_own_thread() const {
  if (std::this_thread::get_id() == thread_) return;
  throw std::runtime_error(
      "this simulation was begun by another thread; go on with it there, or begin one here");
}

std::shared_ptr<Frame> Simulation::next() {
  require_no_fork();
  require_own_thread();
  check_signals();
  if (!source_) return nullptr;
  auto frame = std::make_shared<Frame>();
  bool is_over = true;
  struct AtEnd {  // also if the frame throws
    Simulation& self;
    bool& is_over;
    ~AtEnd() {
      if (!is_over) return;
      self.source_.reset();
      self.simulation_.reset();
    }
  } at_end{*this, is_over};
  {
    const py::gil_scoped_release others_may_run;
    const OneThread one_thread;
    std::optional<bench::InputFrame> seen = bench::next_input_frame(*source_, corners_, true);
    is_over = !seen;
    if (seen) frame->seen = std::move(*seen);
  }
  run_->info.warnings = source_->warnings();
  if (is_over) return nullptr;
  if (simulated_) frame->observation = simulated_->observation();
  frame->run = run_;
  return frame;
}

void bind_frame(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ImuRow, t, gyro, accel);
  PYBIND11_NUMPY_DTYPE(OdometryRow, t, velocity, yaw_rate);
  bind_motion(module);
  bind_truth(module);
  bind_seen(module);
  class_of<Simulation>(
      module, "Simulation",
      "The frames of a scenario, one after another. To be used by the thread that made it; other\n"
      "threads run meanwhile. The same scenario and seed give the same bits.")
      .def(py::init([](std::shared_ptr<Scenario> scenario) {
             return std::make_unique<Simulation>(std::move(scenario));
           }),
           py::arg("scenario").none(false))
      .def("__iter__",
           [](const py::object& self) {
             static_cast<void>(self.cast<const Simulation&>());  // checks the class
             return Frames(self);
           })
      .def("__next__",
           [](Simulation& self) {
             std::shared_ptr<Frame> frame = self.next();
             if (!frame) throw py::stop_iteration();
             return frame;
           })
      .def_property_readonly(
          "scenario",
          [](const Simulation& s) { return std::const_pointer_cast<Scenario>(s.run().scenario); })
      .def_property_readonly(
          "warnings",
          [](const Simulation& s) {
            const recording::RunInfo& run = s.run().info;
            return recording::lines_of(recording::WarningWatch(run.truth).warned(run.warnings));
          },
          "Problems so far, a line each: the rover or an actor ran into something, fell, or tipped "
          "over.");
}

}  // namespace lcs::python
