// Refuses what was asked for and has no effect.
#include <fmt/format.h>

#include "tools/replay/recorded.h"

namespace lcs::replay {

void require_effects(const scenario::RecordingSource& asked, const RecordingLayout& layout,
                     bool exact_motion, const Recorded& recorded) {
  const scenario::RecordingSource::Topics& topics = asked.topics;
  const bool is_bag = layout.name == "bag";
  const bool has_own_lens = asked.focal_px || asked.calibration;
  const bool is_video = !recorded.video.empty();
  constexpr const char* kNotOfBag = "it is of a ROS bag, and this is none";
  constexpr const char* kNoImu = "the camera's motion is not by an IMU whose start is unknown";
  const auto of_bag = [is_bag](const char* why) { return is_bag ? why : kNotOfBag; };
  const struct {
    const char* key;
    bool is_asked;
    const char* why;
    bool has_effect = false;
  } rules[] = {
      {"ego_motion: truth", exact_motion, "no truth of this recording gives the motion"},
      {"camera", !asked.camera.empty(), "the recording has one camera, and no calibration names it",
       layout.has_cameras},
      {"topics.image", !topics.image.empty(), kNotOfBag, is_bag},
      {"topics.camera_info", !topics.camera_info.empty(),
       of_bag("focal or calibration takes its place"), is_bag && !has_own_lens},
      {"topics.imu", !topics.imu.empty(), of_bag("poses or a motion of yours take its place")},
      {"topics.poses", !topics.poses.empty(), of_bag("a motion of yours takes its place")},
      {"topics.odometry", !topics.odometry.empty(),
       of_bag("it is beside an IMU, and none is read")},
      {"topics.world", !topics.world.empty(), of_bag("no poses of the bag are read")},
      {"time_unit", !asked.time_unit.empty(), "no table or name that is read has times in a unit"},
      {"time_offset", asked.time_offset_s.has_value(),
       "the motion of this recording has the clock of its pictures"},
      {"at_rest", asked.at_rest_s.has_value(), kNoImu},
      {"imu_calibration", asked.imu_calibration.has_value(), kNoImu},
      {"calibration", asked.calibration && asked.focal_px,
       "focal takes its place, and the motion needs no place on an IMU"},
      {"mount", asked.mount_rpy_rad.has_value(),
       "the layout states it, or it tells the vertical only, which needs camera_height", false},
      {"labels_video", !asked.labels_video.empty(), "there are no labels",
       asked.labels.has_value()},
      {"bayer", !asked.bayer.empty(), "a video has colours", !is_video},
      {"bits", asked.bits.has_value(), "no picture has 16 bits",
       !is_video && recorded.format.is_deep},
  };
  for (const auto& [key, is_asked, why, has_effect] : rules) {
    const bool is_of_bag = std::string_view(key).starts_with("topics.");
    const bool took = recorded.took.contains(key) && (is_bag || !is_of_bag);
    if (!is_asked || has_effect || took) continue;
    throw input::Error(asked.source, "{} has no effect: {}; remove it", key, why);
  }
}

}  // namespace lcs::replay
