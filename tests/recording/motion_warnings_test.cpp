// Warnings about recordings whose motion cannot be the camera's.
#include "tools/recording/warnings.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/scoring/whole_recordings.h"

namespace lcs::recording {
namespace {

using Points = std::vector<Eigen::Vector2f>;

/// Corners at random places in a picture of 640x480.
Points scattered(int count, unsigned seed) {
  std::mt19937 random(seed);
  Points points;
  for (int i = 0; i < count; ++i) {
    const auto x = static_cast<float>(random() % 640), y = static_cast<float>(random() % 480);
    points.emplace_back(x, y);
  }
  return points;
}

/// A recording at 10 Hz whose corners are moved on from frame to frame.
Recording moving(int frames, const std::function<Eigen::Vector2f(const Eigen::Vector2f&)>& next,
                 const EgoMotion& told, double share_of_rebels = 0) {
  Recording recording;
  recording.truth = Truth::unknown;
  Points points = scattered(400, 1);
  for (int k = 0; k < frames; ++k) {
    FrameRecord& frame = recording.frames.emplace_back();
    frame.index = k;
    frame.t_ns = 100'000'000LL * k;
    frame.motion = told;
    frame.motion.dt_s = k > 0 ? 0.1 : 0;
    // a quarter of the corners occurs in one frame only
    frame.corners_px = points;
    const Points others = scattered(130, 100 + static_cast<unsigned>(k));
    frame.corners_px.insert(frame.corners_px.end(), others.begin(), others.end());
    const std::size_t rebels = static_cast<std::size_t>(share_of_rebels * 530);
    frame.verdicts.assign(frame.corners_px.size(), Verdict::normal);
    std::fill_n(frame.verdicts.begin(), rebels, Verdict::rebel);
    set_corner_truth(recording.truth, frame);
    for (Eigen::Vector2f& point : points) {
      point = next(point);
      point.x() -= 640 * std::floor(point.x() / 640);  // re-enters on the other side
      point.y() -= 480 * std::floor(point.y() / 480);
    }
  }
  return recording;
}

const auto kStill = [](const Eigen::Vector2f& x) { return x; };
const auto kPan = [](const Eigen::Vector2f& x) { return Eigen::Vector2f(x.x() + 14, x.y() - 3); };
/// Motion ahead, past points at any depth.
const auto kAhead = [](const Eigen::Vector2f& x) {
  const Eigen::Vector2f away = x - Eigen::Vector2f(319.5F, 239.5F);
  const float nearness =
      0.02F + 0.08F * static_cast<float>((static_cast<int>(x.y()) * 7) % 10) / 10;
  return Eigen::Vector2f(x + nearness * away);
};

EgoMotion ahead(double speed_mps) {
  EgoMotion motion;
  motion.v_C_mps = {0, 0, speed_mps};
  return motion;
}
EgoMotion turning(double rate_radps) {
  EgoMotion motion;
  motion.R_cur_prev = Eigen::AngleAxisd(0.1 * rate_radps, Eigen::Vector3d::UnitY()).matrix();
  return motion;
}

std::vector<Warned> watched(const Recording& recording) {
  WarningWatch watch(Truth::unknown);
  for (const FrameRecord& frame : recording.frames) watch.add(frame);
  std::vector<Warned> all = watch.warned({});
  std::erase_if(all, [](const Warned& warning) { return !warning.count; });
  return all;
}

/// The keywords of the given warnings, with a space after each.
std::string told(const Recording& recording) {
  std::string words;
  for (const Warned& warning : watched(recording)) {
    EXPECT_EQ(warning.count == 0, warning.text.empty());
    if (warning.count > 0) words += warning.word + ' ';
  }
  return words;
}

std::string text_of(const Recording& recording, const std::string& word) {
  for (const Warned& warning : watched(recording)) {
    if (warning.word == word) return warning.text;
  }
  return "";
}

TEST(MotionWarnings, ThereAreNoneWhereTheMotionIsTheCameras) {
  EXPECT_EQ(told(moving(40, kStill, ahead(0))), "");
  EXPECT_EQ(told(moving(40, kAhead, ahead(10))), "");
  EXPECT_EQ(told(moving(40, kPan, turning(0.3))), "");
  EgoMotion sideways;
  sideways.v_C_mps = {3, 0, 0.1};
  EXPECT_EQ(told(moving(40, kPan, sideways)), "") << "past a wall";
  EXPECT_EQ(told(moving(2, kPan, ahead(0))), "") << "too short to say";
  EXPECT_EQ(told(Recording{}), "");
}

TEST(MotionWarnings, ATurnThatNobodyToldOfIsToldOnceWithItsTime) {
  EXPECT_EQ(told(moving(40, kPan, ahead(0))), "turn_not_told ");
  const Recording drive = moving(40, kPan, ahead(2));
  EXPECT_EQ(told(drive), "turn_not_told ");
  EXPECT_TRUE(text_of(drive, "turn_not_told")
                  .starts_with("the whole picture turns in 39 of 40 frames, first at 0.10 s"));
}

TEST(MotionWarnings, ACameraThatStandsWhileASpeedIsTold) {
  const Recording stands = moving(40, kStill, ahead(4));
  EXPECT_EQ(told(stands), "still_camera ");
  EXPECT_NE(text_of(stands, "still_camera").find("first at 0.30 s"), std::string::npos)
      << text_of(stands, "still_camera");
  EXPECT_EQ(told(moving(40, kStill, ahead(0.5))), "") << "it should have gone on by 2 m only";
}

TEST(MotionWarnings, NothingThatDrivesIsSoFast) {
  EXPECT_EQ(told(moving(20, kAhead, ahead(69))), "");
  const Recording fast = moving(20, kAhead, ahead(90));
  EXPECT_EQ(told(fast), "runaway_speed ");
  EXPECT_TRUE(
      text_of(fast, "runaway_speed").starts_with("the camera is told to move at 90 m/s at 0.00 s"));
}

TEST(MotionWarnings, MostFramesWithManyRebels) {
  EXPECT_EQ(told(moving(20, kAhead, ahead(5), 0.28)), "");
  Recording many = moving(20, kAhead, ahead(5), 0.32);
  EXPECT_EQ(told(many), "many_rebels ");
  EXPECT_TRUE(
      text_of(many, "many_rebels")
          .starts_with("30 % and more of the corners are rebels in 17 of 17 frames, first at "
                       "0.30 s"));
  for (int k = 0; k < 12; ++k) {
    std::fill(many.frames[k].verdicts.begin(), many.frames[k].verdicts.end(), Verdict::normal);
  }
  EXPECT_EQ(told(many), "") << "eight of seventeen";
}

TEST(MotionWarnings, AreAskedOfRecordingsAlone) {
  Recording recording = moving(40, kStill, ahead(4));
  const auto still = [&] {
    for (const Warned& warned : scoring::warnings_of(recording)) {
      if (warned.word == "still_camera") return warned.count;
    }
    return std::optional<std::int64_t>(-1);
  };
  EXPECT_EQ(still(), 13);
  recording.truth = Truth::nothing_moves;
  EXPECT_EQ(still(), 13);
  recording.truth = Truth::all;
  EXPECT_EQ(still(), std::nullopt);
}

}  // namespace
}  // namespace lcs::recording
