// The Python class of frames from outside: pictures and readings of a robot, as they come.
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tools/python/arrays.h"
#include "tools/python/frame.h"
#include "tools/python/guard.h"
#include "tools/python/type.h"
#include "tools/replay/playback.h"
#include "tools/sequence/replay_settings.h"

namespace lcs::python {
namespace {

/// \throws input::Error for a motion that readings do not tell.
sequence::ReplaySettings settings_in(const std::filesystem::path& file) {
  sequence::ReplaySettings settings = sequence::read_settings(file);
  if (settings.scenario.ego_motion == scenario::EgoMotionSource::truth) {
    throw input::Error({file.string(), 0},
                       "ego_motion is truth, which a robot does not have; make it imu");
  }
  settings.scenario.recording.emplace().path = file.parent_path();
  return settings;
}

/// The readings of a sensor that no frame has had yet, with times of the sensor's clock.
template <class Sample>
struct Waiting {
  std::vector<Sample> samples;
  std::optional<std::int64_t> last_ns;  ///< of all so far
};

/// Corners, signatures and motions of the given frames, as a replay of their recording has them.
class Live : bench::FrameSource {
 public:
  explicit Live(const std::filesystem::path& file) : Live(settings_in(file)) {}

  void add_imu(std::int64_t t_ns, const ArrayLike& gyro, const ArrayLike& accel) {
    add(imu_, {t_ns, matrix_of<3, 1>(gyro, "gyro", "3 numbers, rad/s"),
               matrix_of<3, 1>(accel, "accel", "3 numbers, m/s^2")});
  }

  void add_odometry(std::int64_t t_ns, const ArrayLike& velocity, std::optional<double> yaw_rate) {
    add(odometry_, {t_ns, matrix_of<3, 1>(velocity, "velocity", "3 numbers, m/s"), yaw_rate});
  }

  bool is_due(std::int64_t t_ns) {
    const auto has_come = [&](const auto& sensor) {
      return sensor.last_ns && *sensor.last_ns - offset_ns_ >= t_ns;
    };
    return has_come(imu_) && (!run_->scenario->full.odometry.enabled || has_come(odometry_));
  }

  std::shared_ptr<Frame> frame(std::int64_t t_ns, const ArrayLike& picture) {
    const cv::Mat3b image = bgr_of(picture);
    const sim::Pinhole& camera = rectifier_.camera();
    if (image.size() != cv::Size(camera.width_px, camera.height_px)) {
      throw py::value_error(fmt::format(
          "the picture has {} x {} pixels, and the settings say {} x {}; give those of this camera",
          image.cols, image.rows, camera.width_px, camera.height_px));
    }
    require_later(t_ns, last_ns_);
    if (!last_ns_) start_ns_ = t_ns;
    last_ns_ = t_ns;
    given_.t_ns = t_ns - start_ns_;
    given_.image = image;
    given_.imu = taken(imu_);
    given_.odometry = taken(odometry_);
    auto frame = std::make_shared<Frame>();
    frame->run = run_;
    const py::gil_scoped_release others_may_run;
    const OneThread one_thread;
    frame->seen = bench::next_input_frame(*this, corners_, true).value();
    return frame;
  }

  std::shared_ptr<Scenario> scenario() const {
    return std::const_pointer_cast<Scenario>(run_->scenario);
  }
  Diagnostics diagnostics() const override { return feed_.estimator().diagnostics(); }

 private:
  explicit Live(const sequence::ReplaySettings& settings)
      : feed_(settings.scenario, settings.calibration),
        rectifier_(settings.lens, {settings.lens.width_px, settings.lens.height_px}),
        corners_(settings.scenario),
        longest_s_(replay::Playback::kMostPeriods / settings.scenario.camera.rate_hz),
        offset_ns_(std::llround(1e9 * settings.calibration.time_offset_s)) {
    const Camera camera{rectifier_.camera(), settings.scenario.camera.rate_hz};
    run_->scenario =
        std::make_shared<Scenario>(Scenario{settings.scenario, settings.scenario, camera});
    run_->info.scenario = settings.scenario.name;
    run_->info.camera = bench::intrinsics(camera);
    run_->info.truth = recording::Truth::unknown;
  }

  bool next(recording::FrameRecord& frame, cv::Mat3b& image) override {
    frame.index = given_.index++;
    frame.t_ns = given_.t_ns;
    frame.motion = feed_.next(given_).told;
    if (frame.motion.dt_s > longest_s_) frame.motion = {};
    image = given_.image;
    return true;
  }
  bool straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat& picture) const override {
    if (rectifier_.is_pinhole()) return false;
    rectifier_.rectify(corners_px);
    rectifier_.rectify(picture);
    return true;
  }
  void label(recording::FrameRecord& frame) override {
    recording::set_corner_truth(recording::Truth::unknown, frame);
  }

  static void require_later(std::int64_t t_ns, std::optional<std::int64_t> last_ns) {
    constexpr std::int64_t kMost_ns = std::numeric_limits<std::int64_t>::max() / 4;  // sums fit
    if (t_ns < -kMost_ns || t_ns > kMost_ns) {
      throw py::value_error(fmt::format("the time is {} ns; give one since 1970", t_ns));
    }
    if (!last_ns || t_ns > *last_ns) return;
    throw py::value_error(fmt::format(
        "the time goes back from {} to {} ns; begin anew with a new run", *last_ns, t_ns));
  }

  template <class Sample>
  static void add(Waiting<Sample>& waiting, const Sample& sample) {
    require_later(sample.t_ns, waiting.last_ns);
    waiting.last_ns = sample.t_ns;
    waiting.samples.push_back(sample);
  }

  /// Moves the readings up to the frame out, with times since the first frame; without earlier
  /// ones.
  template <class Sample>
  std::vector<Sample> taken(Waiting<Sample>& waiting) const {
    std::vector<Sample> due;
    for (Sample sample : std::exchange(waiting.samples, {})) {
      const std::int64_t run_ns = sample.t_ns - start_ns_ - offset_ns_;
      if (run_ns > given_.t_ns) {
        waiting.samples.push_back(sample);
      } else if (run_ns >= 0) {
        sample.t_ns = run_ns;
        due.push_back(sample);
      }
    }
    return due;
  }

  bench::EgoMotionFeed feed_;
  sim::Rectifier rectifier_;
  bench::CornerFinder corners_;
  double longest_s_;        ///< between frames of which the filter knows corners again
  std::int64_t offset_ns_;  ///< from the camera's clock to the IMU's
  std::shared_ptr<Run> run_ = std::make_shared<Run>();
  Waiting<sim::ImuSample> imu_;
  Waiting<sim::OdometrySample> odometry_;
  sim::Observation given_;               ///< of the next frame, whose number it has
  std::int64_t start_ns_ = 0;            ///< of the first frame, by the camera's clock
  std::optional<std::int64_t> last_ns_;  ///< of the last frame, by the camera's clock
};

}  // namespace

void bind_live(py::module_& module) {
  // Functions of a reference: a method would take None for a null pointer.
  const auto on_live = []<class Return, class... Arguments>(Return (Live::*call)(Arguments...)) {
    return [call](Live& live, Arguments... arguments) { return (live.*call)(arguments...); };
  };
  class_of<Live>(
      module, "Live",
      R"(Frames from outside, as of a robot: the corners, signatures and motions that a replay of its
recording has. Times are ns of one clock, and increase for each sensor.)")
      .def(
          py::init<const std::filesystem::path&>(), py::arg("settings"),
          R"(settings: lcs.json of a generated sequence, with camera, sensors, and the state at the first
frame. Raises Error with file, key and remedy.)")
      .def(
          "add_imu", on_live(&Live::add_imu), py::arg("time_ns"), py::arg("gyro"), py::arg("accel"),
          R"(A reading, 3 numbers each, rad/s and m/s^2, in the IMU's frame. Raises ValueError if the time
goes back.)")
      .def("add_odometry", on_live(&Live::add_odometry), py::arg("time_ns"), py::arg("velocity"),
           py::arg("yaw_rate") = py::none(),
           "A reading of the wheels, as in Frame.odometry; likewise.")
      .def(
          "is_due", on_live(&Live::is_due), py::arg("time_ns"),
          R"(Whether each sensor of the settings has had a reading at this time or later, so that no earlier
one will come.)")
      .def("frame", on_live(&Live::frame), py::arg("time_ns"), py::arg("picture"),
           R"(The next Frame, by the readings up to its time that were added; later ones wait.

picture: H x W x 3 uint8, blue, green, red, as the camera gave it. Raises ValueError for another size
and if the time goes back, and then ignores the picture.)")
      .def_property_readonly(
          "scenario", [](const Live& live) { return live.scenario(); }, "For Filter and Detector.")
      .def_property_readonly(
          "diagnostics", [](const Live& live) { return live.diagnostics().lines(); },
          "Problems of the readings so far, a line for each kind.");
}

}  // namespace lcs::python
