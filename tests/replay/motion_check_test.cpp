// The watch on told motions: pictures of static points whose poses are right, or are written by
// other conventions, with gaps, repeats or interlaced lines.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>

#include "scenarios/load.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/replay/playback.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kFrames = 24, kWidth = 320, kHeight = 240;
constexpr double kFocal_px = 250, kDt_s = 0.1;

/// The camera goes ahead and to the right, and turns about all axes.
sim::Pose pose(double k) {
  const Matrix3d R = (Eigen::AngleAxisd(0.06 * std::sin(0.7 * k), Vector3d::UnitX()) *
                      Eigen::AngleAxisd(0.02 * k, Vector3d::UnitY()) *
                      Eigen::AngleAxisd(0.05 * std::sin(0.5 * k), Vector3d::UnitZ()))
                         .toRotationMatrix();
  return {R, {0.05 * k, 0.06 * std::sin(0.6 * k), 0.2 * k}};
}

cv::Mat1b view(const sim::Pose& T_WC) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  cv::Mat1b picture(kHeight, kWidth, uchar{128});
  for (int i = 0; i < 400; ++i) {
    const Vector3d x_W(24 * share(random) - 12, 14 * share(random) - 7, 26 - 0.05 * i);
    const double grey = 255 * share(random);
    const Vector3d x_C = T_WC.inverse() * x_W;
    if (x_C.z() < 1) continue;
    const cv::Point2d at(kFocal_px * x_C.x() / x_C.z() + 159.5,
                         kFocal_px * x_C.y() / x_C.z() + 119.5);
    const double side = 0.25 * kFocal_px / x_C.z();
    constexpr int kShift = 4;
    const auto fixed = [](const cv::Point2d& p) {
      return cv::Point(cvRound(16 * p.x), cvRound(16 * p.y));
    };
    cv::rectangle(picture, fixed(at), fixed({at.x + side, at.y + side}), cv::Scalar(grey),
                  cv::FILLED, cv::LINE_AA, kShift);
  }
  cv::GaussianBlur(picture, picture, {}, 0.7);
  return picture;
}

class MotionWatched : public testing::Test {
 protected:
  fs::path home() const { return home_.path(); }
  void draw(const std::function<cv::Mat1b(int)>& picture) const {
    for (int k = 0; k < kFrames; ++k) {
      test::write_picture(home() / fmt::format("pictures/{:03}.png", k), picture(k));
    }
  }
  /// What is refused or told, in lines, of poses as `write` makes them of the right ones.
  std::string told(const std::function<std::string(int)>& write) const {
    std::string poses;
    for (int k = 0; k < kFrames; ++k) poses += write(k);
    test::write(home() / "poses.txt", poses);
    return told_by("poses: poses.txt");
  }
  /// As above, of a motion by a key of `recording`.
  std::string told_by(const std::string& motion) const {
    test::write(home() / "drive.yaml",
                fmt::format("recording: {{path: pictures, fps: 10, {}, focal: 250}}\n", motion));
    std::string all;
    const std::string refused = test::refusal_of<input::Error>([&] {
      Playback playback(scenario::load(home() / "drive.yaml"));
      recording::FrameRecord frame;
      int frames = 0;
      for (cv::Mat3b image; playback.next(frame, image);) ++frames;
      all = fmt::format("{} frames\n", frames);
      for (const std::string& line : playback.remarks()) all += line + '\n';
    });
    return all.empty() ? refused : all;
  }
  static std::string tum(int k, const sim::Pose& T) {
    const Eigen::Quaterniond q(T.R);
    return fmt::format("{:.3f} {} {} {} {} {} {} {}\n", 50 + kDt_s * k, T.p.x(), T.p.y(), T.p.z(),
                       q.x(), q.y(), q.z(), q.w());
  }
  const test::TemporaryFolder home_;
};

cv::Mat1b right_view(int k) {
  return view(pose(k));
}

#define EXPECT_TOLD(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)
#define EXPECT_UNTOLD(text, part) EXPECT_EQ((text).find(part), std::string::npos) << (text)

TEST_F(MotionWatched, IsLeftAloneWhereItIsRight) {
  draw(right_view);
  const std::string all = told([](int k) { return tum(k, pose(k)); });
  EXPECT_TOLD(all, "24 frames");
  for (const char* part : {"contradict", "repeat", "alternate", "gap"}) EXPECT_UNTOLD(all, part);
}

TEST_F(MotionWatched, InOtherAxesIsRefusedWithTheirNames) {
  draw(right_view);
  struct Axes {
    const char* said;
    Eigen::Matrix3d R;  // rows: the told axes in the camera's
  };
  const auto rows = [](const Vector3d& x, const Vector3d& y, const Vector3d& z) {
    return Matrix3d((Matrix3d() << x.transpose(), y.transpose(), z.transpose()).finished());
  };
  const Vector3d right(1, 0, 0), down(0, 1, 0), ahead(0, 0, 1);
  for (const auto& [said, A] : {Axes{"x ahead, y right, z down", rows(ahead, right, down)},
                                Axes{"x ahead, y left, z up", rows(ahead, -right, -down)},
                                Axes{"x right, y up, z back", rows(right, -down, -ahead)},
                                Axes{"x left, y up, z ahead", rows(-right, -down, ahead)}}) {
    const Matrix3d axes = A;
    const std::string camera = told([&](int k) {
      return tum(k, {pose(k).R * axes.transpose(), pose(k).p});
    });
    EXPECT_TOLD(camera, said);
    const std::string both = told([&](int k) {
      return tum(k, {axes * pose(k).R * axes.transpose(), axes * pose(k).p});
    });
    EXPECT_TOLD(both, said);
    EXPECT_TOLD(both, "multiply each rotation from the right");
  }
}

TEST_F(MotionWatched, InLeftHandedAxesIsRefusedInEachFrameThatTheyFitWorse) {
  draw(right_view);
  for (const auto& [mirrored, said] : {std::pair(Vector3d(1, -1, 1), "x right, y up, z ahead"),
                                       std::pair(Vector3d(-1, 1, 1), "x left, y down, z ahead")}) {
    const Matrix3d mirror = mirrored.asDiagonal();
    const std::string all = told([&](int k) {
      return tum(k, {mirror * pose(k).R * mirror, mirror * pose(k).p});
    });
    EXPECT_TOLD(all, "left-handed");
    EXPECT_TOLD(all, said);
    int wrong = 0, frames = 0;
    const std::size_t at = std::min(all.find("contradict"), all.size());
    EXPECT_EQ(std::sscanf(all.c_str() + at, "contradict its motion in %d of %d", &wrong, &frames),
              2)
        << all;
    EXPECT_GT(2 * wrong, frames);
    EXPECT_EQ(frames, kFrames - 1);
  }
}

TEST_F(MotionWatched, OfASlowCameraIsJudgedByAllItsFrames) {
  constexpr double kSlow = 0.04;
  draw([](int k) { return view(pose(kSlow * k)); });
  const std::string right = told([](int k) { return tum(k, pose(kSlow * k)); });
  EXPECT_TOLD(right, "24 frames");
  EXPECT_UNTOLD(right, "contradict");
  EXPECT_TOLD(told([](int k) {
                const sim::Pose T = pose(kSlow * k);
                return tum(k, {T.R, -T.p});
              }),
              "contradict its motion in 2");
}

TEST_F(MotionWatched, OfAFewPicturesIsJudged) {
  draw(right_view);
  const auto few = [](int k, const sim::Pose& T) { return k < 6 ? tum(k, T) : std::string(); };
  EXPECT_UNTOLD(told([&](int k) { return few(k, pose(k)); }), "contradict");
  EXPECT_TOLD(told([&](int k) { return few(k, pose(k).inverse()); }), "give their inverse");
}

TEST_F(MotionWatched, BySpeedAloneIsJudgedByAnyTurn) {
  const auto ahead = [](int k) { return sim::Pose{pose(k).R, {0, 0, 0.2 * k}}; };
  // it looks along its way as far as it can be told without its turns
  draw([&](int k) { return view({Matrix3d::Identity(), ahead(k).p}); });
  EXPECT_UNTOLD(told_by("speed: 2"), "contradict");
  EXPECT_TOLD(told_by("speed: -2"), "the camera moves backwards");
  EXPECT_TOLD(told_by("speed: 0"), "the camera moves ahead: give its speed");
  draw([&](int k) { return view({ahead(k).R, Vector3d::Zero()}); });
  EXPECT_UNTOLD(told_by("speed: 0"), "contradict");
}

TEST_F(MotionWatched, ThatIsWrongForAThirdOfTheTimeIsToldWithItsShare) {
  draw(right_view);
  const std::string all = told([](int k) {
    return tum(k, {pose(k < 16 ? k : 32 - k).R, pose(k).p});
  });
  EXPECT_TOLD(all, "24 frames");
  EXPECT_TOLD(all, "the pictures contradict the motion in 7 of 23 frames");
}

TEST_F(MotionWatched, AsTheInverseOrWithWFirstIsRefused) {
  draw(right_view);
  EXPECT_TOLD(told([](int k) { return tum(k, pose(k).inverse()); }), "give their inverse");
  EXPECT_TOLD(told([](int k) {
                const Eigen::Quaterniond q(pose(k).R);
                const Vector3d p = pose(k).p;
                return fmt::format("{:.3f} {} {} {} {} {} {} {}\n", 50 + kDt_s * k, p.x(), p.y(),
                                   p.z(), q.w(), q.x(), q.y(), q.z());
              }),
              "w first");
}

TEST_F(MotionWatched, OnASlopeIsLeftAlone) {
  const auto uphill = [](int k) {
    constexpr double kSlope = 0.15, kRampAt = 8;
    const double pitch = k < kRampAt ? 0 : kSlope;
    return sim::Pose{Eigen::AngleAxisd(pitch, Vector3d::UnitX()).toRotationMatrix(),
                     {0, -0.2 * std::sin(pitch) * (k - kRampAt), 0.2 * k}};
  };
  draw([&](int k) { return view(uphill(k)); });
  EXPECT_UNTOLD(told([&](int k) { return tum(k, uphill(k)); }), "contradict");
}

TEST_F(MotionWatched, OfOtherPicturesIsRefused) {
  draw(right_view);
  EXPECT_TOLD(told([](int k) {
                return tum(k, {pose(-3 * k).R, {0, -0.3 * k, -0.2 * k}});
              }),
              "the pictures contradict its motion in");
}

TEST_F(MotionWatched, LeavesOutPicturesInAGapOfPoses) {
  draw(right_view);
  const std::string all =
      told([](int k) { return k > 6 && k < 15 ? std::string() : tum(k, pose(k)); });
  EXPECT_TOLD(all, "16 frames");
  EXPECT_TOLD(all, "8 pictures are in gaps of the poses");
  EXPECT_TOLD(all,
              "1 gaps are longer than four pictures, and the filter begins anew after them "
              "(the first: 0.90 s before 015.png)");
}

TEST_F(MotionWatched, TakesPosesThatAreHeldForAGap) {
  draw(right_view);
  const std::string all = told([](int k) { return tum(k, pose(k > 6 && k < 15 ? 6 : k)); });
  EXPECT_TOLD(all, "8 poses repeat the one before");
  EXPECT_TOLD(all, "16 frames");
}

TEST_F(MotionWatched, TellsPicturesThatRepeat) {
  draw([](int k) { return right_view(k % 3 == 2 ? k - 1 : k); });
  EXPECT_TOLD(told([](int k) { return tum(k, pose(k)); }), "8 of 23 pictures repeat");
}

TEST_F(MotionWatched, TellsPicturesThatAreInterlaced) {
  draw([](int k) {
    cv::Mat1b both = right_view(k);
    const cv::Mat1b next = view(pose(k + 0.5));
    for (int y = 1; y < both.rows; y += 2) next.row(y).copyTo(both.row(y));
    return both;
  });
  EXPECT_TOLD(told([](int k) { return tum(k, pose(k)); }), "interlaced");
}

TEST_F(MotionWatched, OfAClockThatIsSetBackIsRefused) {
  draw(right_view);
  EXPECT_TOLD(told([](int k) {
                std::string lines;
                for (int i = 0; i < 20; ++i) {
                  const int at = 20 * k + i;
                  lines += tum(0, pose(k + 0.05 * i))
                               .replace(0, 6, fmt::format("{:.3f}", 50 + 0.005 * (at % 300)));
                }
                return lines;
              }),
              "falls back");
}

TEST_F(MotionWatched, OfTheNeutralFolderNeedsNoOption) {
  std::string times = "time_ns,picture\n", poses = "time_ns,x,y,z,qx,qy,qz,qw\n";
  for (int k = 0; k < kFrames; ++k) {
    test::write_picture(home() / fmt::format("drive/pictures/{:06}.png", k), right_view(k));
    times += fmt::format("{},{:06}.png\n", 100'000'000LL * k, k);
    std::string line = tum(k, pose(k));
    std::ranges::replace(line, ' ', ',');
    poses += std::to_string(100'000'000LL * k) + line.substr(line.find(','));
  }
  test::write(home() / "drive/times.csv", times);
  test::write(home() / "drive/poses.csv", poses);
  test::write(
      home() / "drive/calibration.yaml",
      "camera_model: pinhole\nresolution: [320, 240]\nintrinsics: [250, 250, 159.5, 119.5]\n"
      "distortion_model: none\n");
  test::write(home() / "drive.yaml", "recording: {path: drive}\n");
  Playback playback(scenario::load(home() / "drive.yaml"));
  recording::FrameRecord frame;
  int frames = 0;
  for (cv::Mat3b image; playback.next(frame, image);) {
    if (frames++ == 0) continue;
    const Vector3d way_W = pose(frames - 1).p - pose(frames - 2).p;
    const Vector3d way_C = pose(frames - 1).R.transpose() * way_W;
    EXPECT_LT((frame.motion.v_C_mps * kDt_s - way_C).norm(), 1e-4);
  }
  EXPECT_EQ(frames, kFrames);
}

}  // namespace
}  // namespace lcs::replay
