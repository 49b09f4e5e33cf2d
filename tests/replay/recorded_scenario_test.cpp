// Scenarios with recorded frames, in layouts written here after their public description: a camera
// drives past a wall, and the recording is replayed with its poses, its IMU or its
// speed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "scenarios/load.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tests/tools/videos.h"
#include "tools/recording/recording_io.h"
#include "tools/replay/playback.h"
#include "tools/scoring/figures_file.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using test::CommandResult;
using test::run_lcs;
using test::write;

constexpr int kFrames = 4;
constexpr double kDt_s = 0.1, kSpeed_mps = 2, kYawRate_radps = 0.2;

/// Picture of a scene that moves by 4 px per frame.
cv::Mat3b view(int frame) {
  cv::Mat3b picture(120, 160, cv::Vec3b(190, 190, 190));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      cv::rectangle(picture, {12 + 36 * column + 4 * frame, 12 + 36 * row, 14, 12},
                    cv::Scalar(20, 40, 60), cv::FILLED);
    }
  }
  cv::GaussianBlur(picture, picture, {}, 0.8);
  return picture;
}

/// T_WC of frame k, for any k: the camera moves ahead along z of a world whose y points down, and
/// turns to the left.
sim::Pose pose(double k) {
  const double turn = -kYawRate_radps * kDt_s * k;  // about y, which points down
  return {Eigen::AngleAxisd(turn, Vector3d::UnitY()).toRotationMatrix(),
          {0, 0, kSpeed_mps * kDt_s * k}};
}

std::string kitti_line(const sim::Pose& pose) {
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) line += fmt::format("{:e} ", pose.R(row, column));
    line += fmt::format("{:e}{}", pose.p[row], row < 2 ? " " : "\n");
  }
  return line;
}

/// A TUM line, in a world with z up.
std::string tum_line(double t_s, const sim::Pose& pose) {
  Eigen::Matrix3d R_up_down;
  R_up_down << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond q(R_up_down * pose.R);
  const Vector3d p = R_up_down * pose.p;
  return fmt::format("{:.6f} {:.7f} {:.7f} {:.7f} {:.9f} {:.9f} {:.9f} {:.9f}\n", t_s, p.x(), p.y(),
                     p.z(), q.x(), q.y(), q.z(), q.w());
}

class RecordedScenario : public testing::Test {
 protected:
  fs::path home() const { return home_.path(); }
  void draw(const fs::path& folder, const std::string& format, int first = 0) const {
    fs::create_directories(folder);
    for (int k = 0; k < kFrames; ++k) {
      test::write_picture(folder / fmt::format(fmt::runtime(format), first + k), view(k));
    }
  }
  fs::path scenario_file(const std::string& recording, const std::string& more = "") const {
    write(home() / "drive.yaml", "recording: {" + recording + "}\n" + more);
    return home() / "drive.yaml";
  }
  Playback playback(const std::string& recording, const std::string& more = "") const {
    return Playback(scenario::load(scenario_file(recording, more)));
  }
  std::string refusal(const std::string& recording) const {
    return test::refusal_of<std::runtime_error>([&] { playback(recording); });
  }
  std::string poses(bool tum, int count = kFrames) const {
    std::string text;
    for (int k = 0; k < count; ++k) {
      text += tum ? tum_line(100 + kDt_s * k, pose(k)) : kitti_line(pose(k));
    }
    return text;
  }
  const test::TemporaryFolder home_;
};

struct Seen {
  std::vector<recording::FrameRecord> frames;
  std::vector<cv::Mat3b> images;
};

Seen all_of(Playback& playback) {
  Seen seen;
  while (true) {
    recording::FrameRecord frame;
    cv::Mat3b image;
    if (!playback.next(frame, image)) return seen;
    seen.frames.push_back(frame);
    seen.images.push_back(image);
  }
}

/// Requires the pictures of the frames and the motion of `pose`.
void expect_drive(const Seen& seen, int every = 1) {
  ASSERT_EQ(seen.frames.size(), static_cast<std::size_t>(kFrames / every));
  for (std::size_t k = 0; k < seen.frames.size(); ++k) {
    SCOPED_TRACE(k);
    const EgoMotion& motion = seen.frames[k].motion;
    EXPECT_LT(cv::norm(seen.images[k], view(every * static_cast<int>(k)), cv::NORM_INF), 60)
        << "it is that picture, but for compression";
    EXPECT_EQ(seen.frames[k].index, static_cast<int>(k));
    if (k == 0) continue;
    EXPECT_NEAR(motion.dt_s, every * kDt_s, 1e-6);
    EXPECT_NEAR(motion.w_C_radps.y(), -kYawRate_radps, 1e-4);
    EXPECT_NEAR(motion.w_C_radps.x(), 0, 1e-4);
    const Vector3d v_C =
        pose(every * static_cast<double>(k)).R.transpose() * Vector3d(0, 0, kSpeed_mps);
    EXPECT_LT((motion.v_C_mps - v_C).norm(), 1e-4);
  }
}

void expect_ground(const Seen& seen, double height_m, const Vector3d& up_C) {
  for (const recording::FrameRecord& frame : seen.frames) {
    ASSERT_TRUE(frame.motion.ground);
    EXPECT_EQ(frame.motion.ground->height_m, height_m);
    EXPECT_LT((frame.motion.ground->up_C - up_C).norm(), 1e-6);
  }
}

TEST_F(RecordedScenario, OfKittiOdometryHasItsTimesItsPosesAndItsGround) {
  const fs::path folder = home() / "sequences" / "07";
  draw(folder / "image_0", "{:06}.png");
  write(folder / "calib.txt",
        "P0: 700 0 80 0 0 700 60 0 0 0 1 0\nP1: 700 0 80 -70 0 700 60 0 0 0 1 0\n");
  std::string times;
  for (int k = 0; k < kFrames; ++k) times += fmt::format("{:e}\n", kDt_s * k);
  write(folder / "times.txt", times);
  write(home() / "poses" / "07.txt", poses(false));  // where the benchmark stores them
  Playback drive = playback("path: sequences/07, camera_height: 165 cm");
  EXPECT_EQ(drive.camera().focal_px, 700);
  EXPECT_EQ(drive.camera().centre_px, Eigen::Vector2d(80, 60));
  const Seen seen = all_of(drive);
  expect_drive(seen);
  expect_ground(seen, 1.65, {0, -1, 0});

  // Camera 1 is 0.1 m to the right of camera 0, so it is faster in a turn to the left.
  draw(folder / "image_1", "{:06}.png");
  Playback right = playback("path: sequences/07, camera: image_1");
  const Seen from_right = all_of(right);
  EXPECT_NEAR(from_right.frames[1].motion.v_C_mps.z(),
              seen.frames[1].motion.v_C_mps.z() + 0.1 * kYawRate_radps, 1e-3);
  EXPECT_FALSE(from_right.frames[1].motion.ground) << "how high it is was not said";
  ASSERT_FALSE(right.remarks().empty());
  EXPECT_NE(right.remarks().back().find("camera_height"), std::string::npos);
}

TEST_F(RecordedScenario, OfTumRgbdHasTheMotionBetweenItsPosesAtTheTimesOfItsPictures) {
  draw(home() / "desk" / "rgb", "{}.png");
  std::string list = "# color images\n# file: 'desk.bag'\n# timestamp filename\n", truth;
  for (int k = 0; k < kFrames; ++k) list += fmt::format("{:.6f} rgb/{}.png\n", 100 + kDt_s * k, k);
  for (int i = -1; i < 5 * kFrames; ++i) {  // at other times, and more often
    truth += tum_line(100 + kDt_s * (0.2 * i + 0.1), pose(0.2 * i + 0.1));
  }
  write(home() / "desk" / "rgb.txt", list + "\v \f\n");  // a blank line
  write(home() / "desk" / "groundtruth.txt", "# ground truth trajectory\n# timestamp tx\n" + truth);
  Playback drive = playback("path: desk, focal: 517, camera_height: 1 m");
  const Seen seen = all_of(drive);
  expect_drive(seen);
  expect_ground(seen, 1, {0, -1, 0});
  EXPECT_EQ(drive.camera().centre_px, Eigen::Vector2d(79.5, 59.5)) << "the middle";
}

TEST_F(RecordedScenario, OfMotChallengeHasItsRateAndMovesAsTheUserSays) {
  draw(home() / "MOT17-02" / "img1", "{:06}.jpg", 1);
  write(
      home() / "MOT17-02" / "seqinfo.ini",
      "[Sequence]\r\nname=MOT17-02\r\nimDir=img1\r\nframeRate=10\r\nseqLength=4\r\nimExt=.jpg\r\n");
  write(home() / "poses.txt", poses(false));
  Playback drive = playback("path: MOT17-02, poses: poses.txt, focal: 300");
  expect_drive(all_of(drive));
  Playback standing = playback("path: MOT17-02, speed: 0 m/s, focal: 300");
  const Seen seen = all_of(standing);
  EXPECT_EQ(seen.frames[3].motion.v_C_mps, Vector3d::Zero());
  EXPECT_NEAR(seen.frames[3].motion.dt_s, 0.1, 1e-9);
  EXPECT_NEAR(seen.frames[3].motion.unseen_turn_rad, unseen_turn_rad(0.1), 1e-9)
      << "nothing tells of turns";
}

TEST_F(RecordedScenario, OfAVideoHasItsPicturesAtItsRateOrAtTheUsers) {
  const std::string file = (home() / "road.avi").string();
  {
    const auto video = test::new_video(file, "MJPG", 10, {160, 120});
    for (int k = 0; k < kFrames; ++k) video->write(view(k));
  }
  write(home() / "poses.txt", poses(true));
  Playback drive = playback("path: road.avi, poses: poses.txt, focal: 300");
  expect_drive(all_of(drive));
  Playback half = playback("path: road.avi, poses: poses.txt, focal: 300, every: 2");
  expect_drive(all_of(half), 2);
  Playback slow = playback("path: road.avi, speed: 1 m/s, focal: 300, fps: 5 Hz", "frames: 2\n");
  const Seen seen = all_of(slow);
  ASSERT_EQ(seen.frames.size(), 2u);
  EXPECT_NEAR(seen.frames[1].motion.dt_s, 0.2, 1e-9);
  write(home() / "words.avi", "not a video");
  EXPECT_NE(refusal("path: words.avi, speed: 0, focal: 300").find("words.avi is no video"),
            std::string::npos);
}

/// Writes a 32-bit number `behind` bytes after each occurrence of a word.
std::string with_number(std::string bytes, const std::string& word, std::size_t behind,
                        std::uint32_t number) {
  std::size_t at = bytes.find(word);
  EXPECT_NE(at, std::string::npos) << word;
  for (; at != std::string::npos; at = bytes.find(word, at + 1)) {
    for (std::size_t i = 0; i < 4; ++i) {
      bytes.at(at + word.size() + behind + i) = static_cast<char>(number >> (8 * i));
    }
  }
  return bytes;
}

TEST_F(RecordedScenario, OfAVideoEndsWithItsFileWhateverItsHeaderCounts) {
  const fs::path file = home() / "road.avi";
  {
    const auto video = test::new_video(file, "MJPG", 10, {160, 120});
    for (int k = 0; k < kFrames; ++k) video->write(view(k));
  }
  const std::string recording = "path: road.avi, speed: 0, focal: 300", whole = test::read(file);
  ASSERT_NO_THROW(playback(recording));
  // The lengths in the headers of the file and of its stream.
  constexpr std::size_t kFramesOfFile = 20, kFramesOfStream = 36;
  for (const std::uint32_t count : {90'000'000U, 100U}) {
    write(file, with_number(with_number(whole, "avih", kFramesOfFile, count), "strh",
                            kFramesOfStream, count));
    Playback longer = playback(recording);
    EXPECT_EQ(all_of(longer).frames.size(), static_cast<std::size_t>(kFrames));
    EXPECT_EQ(longer.remarks()[0],
              fmt::format("the video ends after 4 of the {} pictures of its header", count));
  }
  // FFmpeg uses the size in the JPEG pictures, not that in the file's header.
  write(file, with_number(with_number(whole, "strf", 8, 32'000), "strf", 12, 32'000));
  EXPECT_NO_THROW(playback(recording));
  std::string huge = whole;
  const std::string start_of_frame("\xff\xc0\0\x11", 4), size("\x7d\0\x7d\0", 4);
  for (std::size_t at = huge.find(start_of_frame); at != std::string::npos;
       at = huge.find(start_of_frame, at + 1)) {
    huge.replace(at + 5, size.size(), size);  // 32000 x 32000
  }
  ASSERT_NE(huge, whole);
  write(file, huge);
  const std::string told = refusal(recording);
  EXPECT_NE(told.find("road.avi can be read (the first: picture 0 of "), std::string::npos) << told;
}

TEST_F(RecordedScenario, OfWhatFfmpegOnlyTakesForAVideoIsRefused) {
  {
    const auto video = test::new_video(home() / "real.ts", "mpg2", 25, {160, 120});
    for (int k = 0; k < 20; ++k) video->write(view(k % kFrames));
  }
  const std::string playlist =
      "#EXTM3U\n#EXT-X-VERSION:3\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nreal.ts\n#EXT-X-ENDLIST\n";
  const std::string concat = "ffconcat version 1.0\nfile real.ts\n";
  for (const auto& [name, text] :
       {std::pair<const char*, std::string>{"notes.txt", std::string(2000, 'a') + "\n"},
        {"list.mp4", playlist},
        {"list.m3u8", playlist},
        {"list.avi", concat},
        {"session.sdp",
         "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\n"
         "m=video 5004 RTP/AVP 96\na=rtpmap:96 H264/90000\n"},
        {"text.nut", "a b c"}}) {
    write(home() / name, text);
    const std::string told = refusal(fmt::format("path: {}, speed: 0, focal: 300", name));
    EXPECT_NE(told.find(std::string(name) + " is no video that can be read; "), std::string::npos)
        << told;
  }
  test::write_picture(home() / "one.png", view(0));
  EXPECT_NE(refusal("path: one.png, speed: 0, focal: 300").find("one.png is no video"),
            std::string::npos);
}

TEST_F(RecordedScenario, OfAVideoLeavesTheOptionsOfOthersAsTheyWere) {
  constexpr const char* kVariable = "OPENCV_FFMPEG_CAPTURE_OPTIONS";
  write(home() / "words.avi", "not a video");
  for (const char* before : {"", "fflags;nobuffer"}) {
    ::setenv(kVariable, before, 1);
    refusal("path: words.avi, speed: 0, focal: 300");
    EXPECT_STREQ(std::getenv(kVariable), before);
  }
  ::unsetenv(kVariable);
  refusal("path: words.avi, speed: 0, focal: 300");
  EXPECT_EQ(std::getenv(kVariable), nullptr);
}

TEST_F(RecordedScenario, OfPicturesThatClaimToBeHugeIsRefusedBeforeTheyAreDecoded) {
  draw(home() / "pictures", "{}.png");
  std::string bytes = test::read(home() / "pictures" / "1.png");
  bytes.replace(16, 8, std::string("\0\0\x7d\0\0\0\x7d\0", 8));  // 32000 x 32000
  write(home() / "pictures" / "1.png", bytes);
  const std::string recording = "path: pictures, fps: 10, focal: 300, speed: 0";
  Playback some = playback(recording);
  EXPECT_EQ(all_of(some).frames.size(), 3u);
  EXPECT_NE(some.remarks()[0].find("1.png: the picture has 32000 x 32000 pixels, and can have"),
            std::string::npos)
      << some.remarks()[0];
  write(home() / "mask.png", bytes);
  EXPECT_NE(refusal(recording + ", mask: mask.png").find("32000 x 32000 pixels, and can have"),
            std::string::npos);
  for (const char* name : {"0.png", "2.png", "3.png"}) write(home() / "pictures" / name, bytes);
  EXPECT_NE(refusal(recording).find("none of the pictures in"), std::string::npos);
}

TEST_F(RecordedScenario, OfPicturesWithPosesTakesTheirTimesOrTheUsersRate) {
  draw(home() / "pictures", "view{}.png");
  write(home() / "tum.txt", poses(true));
  write(home() / "kitti.txt", poses(false));
  Playback by_poses = playback("path: pictures, poses: tum.txt, focal: 300");
  expect_drive(all_of(by_poses));
  Playback by_rate = playback("path: pictures, poses: tum.txt, focal: 300, fps: 10");
  expect_drive(all_of(by_rate));
  Playback by_line = playback("path: pictures, poses: kitti.txt, focal: 300, fps: 10, every: 2");
  expect_drive(all_of(by_line), 2);
  // Fewer poses than pictures, each pose at its picture.
  write(home() / "kitti.txt", poses(false, 2));
  Playback fewer = playback("path: pictures, poses: kitti.txt, focal: 300, fps: 10");
  EXPECT_EQ(all_of(fewer).frames.size(), 2u);
  EXPECT_NE(fewer.remarks().at(1).find("2 pictures have no pose"), std::string::npos);
}

TEST_F(RecordedScenario, OfKittiRawTakesJpegAndTheClockOfTheNavigation) {
  const fs::path drive = home() / "drive";
  draw(drive / "image_00" / "data", "{:010}.jpg");
  std::string times;
  for (int k = 0; k < kFrames; ++k) {
    times += fmt::format("2011-10-03 12:00:{:012.9f}\n", kDt_s * k);
    const double yaw = kYawRate_radps * kDt_s * k;
    write(
        drive / "oxts/data" / fmt::format("{:010}.txt", k),
        fmt::format("49 8 116 0 0 {} {} {} 2 0 0 0 0 9.8 0 0 9.8 0 0 .2 0 0 .2 .1 .05 4 10 4 4 0\n",
                    yaw, kSpeed_mps * std::sin(yaw), kSpeed_mps * std::cos(yaw)));
  }
  write(drive / "oxts/timestamps.txt", times);
  Playback playback_of_it = playback("path: drive, focal: 700, camera_height: 1.65");
  const Seen seen = all_of(playback_of_it);
  ASSERT_EQ(seen.frames.size(), 4u);
  EXPECT_NEAR(seen.frames[2].motion.w_C_radps.y(), -kYawRate_radps, 1e-4);
  EXPECT_NEAR(seen.frames[2].motion.v_C_mps.z(), kSpeed_mps, 1e-2);
  expect_ground(seen, 1.65, {0, -1, 0});
  EXPECT_NE(playback_of_it.remarks().front().find("the times of the navigation are used"),
            std::string::npos);
}

TEST_F(RecordedScenario, GroundIsWhereTheMountSaysThatItIs) {
  draw(home() / "pictures", "{}.png");
  const std::string pictures = "path: pictures, fps: 10, focal: 300, camera_height: 0.5";
  const double pitch = std::numbers::pi / 18;
  const Vector3d looking_down(0, -std::cos(pitch), -std::sin(pitch));
  Playback mounted = playback(pictures + ", speed: 1, mount: [0, 10 deg, 0]");
  expect_ground(all_of(mounted), 0.5, looking_down);
  Playback unknown = playback(pictures + ", speed: 1");
  EXPECT_FALSE(all_of(unknown).frames[1].motion.ground);
  EXPECT_NE(unknown.remarks().back().find("give mount"), std::string::npos);

  std::string imu = "#timestamp [ns],w_RS_S_x,w_RS_S_y,w_RS_S_z,a_RS_S_x,a_RS_S_y,a_RS_S_z\n";
  for (int i = 0; i <= 60; ++i)
    imu += fmt::format("{},0,0,0,0,0,9.81\n", 7'000'000 + 5'000'000 * i);
  write(home() / "imu.csv", imu);
  Playback felt = playback(pictures + ", imu: imu.csv, speed: 2, mount: [0, 10 deg, 0]");
  const Seen seen = all_of(felt);
  expect_ground(seen, 0.5, looking_down);
  EXPECT_NEAR(seen.frames[3].motion.v_C_mps.z(), 2, 1e-3);

  // From the mount on a vehicle that is upright at the first pose, in any world of the poses.
  write(home() / "poses.txt", poses(true));
  Playback posed = playback(pictures + ", poses: poses.txt, mount: [0, 10 deg, 0]");
  const Seen moved = all_of(posed);
  EXPECT_LT((moved.frames[0].motion.ground.value().up_C - looking_down).norm(), 1e-6);
}

TEST_F(RecordedScenario, AllThatItLacksIsToldInOneMessage) {
  draw(home() / "pictures", "{}.png");
  const std::string message = refusal("path: pictures");
  EXPECT_NE(message.find("drive.yaml:1: "), std::string::npos) << message;
  for (const char* needed :
       {"(fps, or times)", "(poses, imu, or speed: 0 where it stands)", "(focal)"}) {
    EXPECT_NE(message.find(needed), std::string::npos) << message;
  }
  write(home() / "poses.txt", poses(true, 3));
  EXPECT_NE(refusal("path: pictures, poses: poses.txt, focal: 300")
                .find("which of 3 poses belong to its 4 pictures (fps"),
            std::string::npos);
  write(home() / "poses.txt", poses(false));
  EXPECT_NE(refusal("path: pictures, poses: poses.txt, focal: 300").find("(fps, or times)"),
            std::string::npos);
}

TEST_F(RecordedScenario, UnusableInputIsRefusedWithItsPlace) {
  draw(home() / "pictures", "{}.png");
  const std::string pictures = "path: pictures, fps: 10, focal: 300, ";
  write(home() / "poses.txt", "1 2 3\n");
  EXPECT_NE(refusal(pictures + "poses: poses.txt").find("poses.txt:1: a pose has 8 numbers"),
            std::string::npos);
  write(home() / "poses.txt", "# t x y z\n1 0 0 0 0 0 0 7\n");
  EXPECT_NE(refusal(pictures + "poses: poses.txt").find("poses.txt: holds no pose"),
            std::string::npos);
  test::write_picture(home() / "mask.png", cv::Mat1b(20, 20, uchar{255}));
  EXPECT_NE(refusal(pictures + "speed: 0, mask: mask.png").find("mask.png is of 20 x 20 pixels"),
            std::string::npos);
  write(home() / "mask.png", "not a picture");
  EXPECT_NE(refusal(pictures + "speed: 0, mask: mask.png").find("mask.png': this is no picture"),
            std::string::npos);
  EXPECT_NE(refusal(pictures + "speed: 0, format: mot").find("seqinfo.ini: there is no such file"),
            std::string::npos);
  EXPECT_NE(
      refusal(pictures + "speed: 0, distortion: [900, 0, 0, 0, 0]").find("a tenth of its own"),
      std::string::npos);
  const fs::path odometry = home() / "07";
  draw(odometry / "image_0", "{:06}.png");
  write(odometry / "calib.txt", "P0: 0.5 0 80 0 0 0.5 60 0 0 0 1 0\n");
  write(odometry / "times.txt", "0\n.1\n.2\n.3\n");
  EXPECT_NE(refusal("path: 07, speed: 1").find("px fit no camera"), std::string::npos);
  EXPECT_NE(refusal("path: 07, speed: 1, fps: 12").find("remove fps"), std::string::npos);
  write(odometry / "calib.txt", "P0: 700 0 80\n");
  EXPECT_NE(refusal("path: 07, speed: 1").find("P0 is missing, or is not 12 numbers"),
            std::string::npos);
}

TEST_F(RecordedScenario, CornersOfTheVehicleItselfAreLeftOut) {
  draw(home() / "pictures", "{}.png");
  cv::Mat1b mask(120, 160, uchar{0});
  mask.rowRange(60, 120) = 255;
  test::write_picture(home() / "mask.png", mask);
  Playback masked = playback("path: pictures, fps: 10, focal: 300, speed: 0, mask: mask.png");
  std::vector<Eigen::Vector2f> corners{{10, 20}, {10, 59.4F}, {10, 60}, {159, 119}};
  cv::Mat3b image = view(0);
  EXPECT_FALSE(masked.straighten(corners, image)) << "the picture is as it was";
  EXPECT_EQ(corners.size(), 2u);
}

TEST_F(RecordedScenario, IsRunAndRecordedAndComparedAsAnyOther) {
  draw(home() / "pictures", "{}.png");
  const fs::path file =
      scenario_file("path: pictures, fps: 10, focal: 300, speed: 0, nothing_moves: true",
                    "criteria: [{metric: rebel.false_corners_per_frame, max: 1000}]\n");
  const auto lcs = [&](std::vector<std::string> arguments) {
    return run_lcs(arguments, {.folder = home()});
  };
  CommandResult result = lcs({"run", file, "--events", "--no-video", "--out", home() / "first",
                              "--beside", "klt=" + (home() / "klt").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("drive: 4 pictures, 0 skipped"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("where the ground is"), std::string::npos) << result.err;
  const auto metrics = nlohmann::json::parse(test::read(home() / "first" / scoring::kMetricsFile));
  EXPECT_TRUE(metrics["ego.rotation_error_mrad_median"].is_null()) << "nobody knows the truth";
  EXPECT_TRUE(metrics["square.precision_50"].is_null());
  EXPECT_TRUE(metrics["rebel.recall"].is_null()) << "nothing moves";
  EXPECT_TRUE(fs::exists(home() / "klt" / scoring::kMetricsFile));

  result =
      lcs({"run", file, "--recorded", home() / "first", "--no-video", "--out", home() / "again"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(test::read(home() / "first" / recording::kLayersFile),
            test::read(home() / "again" / recording::kLayersFile));

  // One run for any number of seeds.
  result = lcs({"suite", file, "--seeds", "3", "--out", home() / "suite"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::exists(home() / "suite/runs/drive/seed-1"));
  EXPECT_FALSE(fs::exists(home() / "suite/runs/drive/seed-2"));
  EXPECT_TRUE(fs::exists(home() / "suite/report.html"));
  result = lcs({"compare", home() / "suite", home() / "suite"});
  EXPECT_EQ(result.exit_code, 0) << result.err;

  result = lcs({"generate", file, "--out", home() / "sequence"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("these are recorded frames"), std::string::npos) << result.err;
  result = lcs({"run", file, "--set", "recording.camera_hieght=1"});
  EXPECT_NE(result.err.find("did you mean 'camera_height'?"), std::string::npos) << result.err;
}

TEST_F(RecordedScenario, OfABagWithoutRosbagsTellsHowToGetIt) {
  write(home() / "python" / "rosbags.py", "raise ImportError\n");
  write(home() / "drive.bag", "#ROSBAG V2.0\n");
  ASSERT_EQ(::setenv("PYTHONPATH", (home() / "python").c_str(), 1), 0);
  const std::string told = refusal("path: drive.bag, topics: {image: /camera}");
  ::unsetenv("PYTHONPATH");
  EXPECT_NE(
      told.find("drive.bag: reading bags needs the Python package rosbags; install it with: "),
      std::string::npos)
      << told;
  EXPECT_NE(told.find("-m pip install rosbags"), std::string::npos) << told;
}

TEST_F(RecordedScenario, OfAVideoWithATableOfTimesHasThem) {
  {
    const auto video = test::new_video(home() / "road.avi", "MJPG", 10, {160, 120});
    for (int k = 0; k < kFrames; ++k) video->write(view(k));
  }
  write(home() / "times.csv", "frame,time_ms\n0,5000\n1,5100\n2,5350\n3,5400\n");
  Playback timed = playback("path: road.avi, times: times.csv, speed: 0, focal: 300");
  std::vector<std::int64_t> t_ms;
  for (const auto& frame : all_of(timed).frames) t_ms.push_back(frame.t_ns / 1'000'000);
  EXPECT_EQ(t_ms, (std::vector<std::int64_t>{5000, 5100, 5350, 5400}));
}

TEST_F(RecordedScenario, LabelsOfAVideoAreThoseOfItsPicturesInOrder) {
  {
    const auto video = test::new_video(home() / "road.avi", "MJPG", 10, {160, 120});
    for (int k = 0; k < kFrames; ++k) video->write(view(k));
  }
  write(home() / "gt.txt", "1,1,1,1,5,5\n4,1,9,1,5,5\n");
  const std::string recording = "path: road.avi, speed: 0, focal: 300, labels: gt.txt";
  Playback labelled = playback(recording);
  for (int k = 0; k < kFrames; ++k) {
    recording::FrameRecord frame;
    cv::Mat3b image;
    ASSERT_TRUE(labelled.next(frame, image));
    labelled.label(frame);
    EXPECT_EQ(frame.labels.has_value(), k == 0 || k == 3) << k;
  }
  write(home() / "gt.txt", "1,1,1,1,5,5\n5,1,9,1,5,5\n");
  EXPECT_NE(refusal(recording).find("gt.txt: they go to frame 5, and the recording has 4 pictures"),
            std::string::npos)
      << refusal(recording);
}

TEST_F(RecordedScenario, AUnitOfTimeIsThatOfTheImuWherePicturesHaveARate) {
  draw(home() / "pictures", "{:06}.png");
  std::string imu = "t,w_x,w_y,w_z,a_x,a_y,a_z\n";
  for (int i = 0; i < 100; ++i) imu += fmt::format("{},0,0,0,0,0,9.81\n", 5 * i);
  write(home() / "imu.csv", imu);
  Playback timed =
      playback("path: pictures, fps: 10, focal: 300, imu: imu.csv, speed: 1, time_unit: ms");
  EXPECT_EQ(all_of(timed).frames.size(), static_cast<std::size_t>(kFrames));
}

TEST_F(RecordedScenario, ATimeOffsetMovesPicturesToTheClockOfTheImu) {
  draw(home() / "pictures", "{}.png");
  std::string imu = "time_ms,w_x,w_y,w_z,a_x,a_y,a_z\n";
  for (int t_ms = 0; t_ms <= 600; t_ms += 5) {
    imu += fmt::format("{0},0,0,{1},0,0,9.81\n", t_ms, 1e-3 * t_ms);  // turns faster and faster
  }
  write(home() / "imu.csv", imu);
  const auto turns = [&](int late_ms, const std::string& more) {
    std::string times = "frame,time_ms\n";
    for (int k = 0; k < kFrames; ++k) times += fmt::format("{},{}\n", k, 100 * (k + 1) - late_ms);
    write(home() / "times.csv", times);
    Playback read =
        playback("path: pictures, times: times.csv, focal: 300, imu: imu.csv, speed: 0" + more);
    std::vector<double> turns_rad;
    for (const recording::FrameRecord& frame : all_of(read).frames) {
      turns_rad.push_back(Eigen::AngleAxisd(frame.motion.R_cur_prev).angle());
    }
    return turns_rad;
  };
  const std::vector<double> exact = turns(0, "");
  EXPECT_NEAR(exact.back(), 0.5 * (0.4 * 0.4 - 0.3 * 0.3), 1e-3) << "the integral of t from 0.3 s";
  EXPECT_EQ(turns(40, ", time_offset: 40 ms"), exact);
  EXPECT_LT(turns(40, "").back(), 0.9 * exact.back());
  EXPECT_NE(refusal("path: pictures, fps: 10, focal: 300, speed: 0, time_offset: 40 ms")
                .find("time_offset has no effect"),
            std::string::npos);
}

TEST_F(RecordedScenario, OfPicturesOfTwoSizesTakesThatOfMost) {
  draw(home() / "pictures", "{}.png");
  test::write_picture(home() / "pictures" / "0.png", cv::Mat1b(20, 20, uchar{255}));
  Playback most = playback("path: pictures, fps: 10, focal: 300, speed: 0");
  EXPECT_EQ(all_of(most).frames.size(), static_cast<std::size_t>(kFrames - 1));
  EXPECT_EQ(most.camera().width_px, 160);
}

TEST_F(RecordedScenario, OfPicturesThatUse12Of16BitsIsAsBrightAsOf8) {
  for (int k = 0; k < kFrames; ++k) {
    cv::Mat deep;
    view(k).convertTo(deep, CV_16U, 16);              // 255 becomes 4080
    deep.reshape(1).at<std::uint16_t>(0, 0) = 65535;  // a hot pixel, of blue
    test::write_picture(home() / "deep" / fmt::format("{}.png", k), deep);
  }
  Playback deep = playback("path: deep, fps: 10, focal: 300, speed: 0");
  EXPECT_NE(deep.remarks()[0].find("pictures of 16 bits use fewer"), std::string::npos)
      << deep.remarks()[0];
  const Seen seen = all_of(deep);
  ASSERT_EQ(seen.images.size(), static_cast<std::size_t>(kFrames));
  for (int k = 0; k < kFrames; ++k) {
    cv::Mat3b expected = view(k);
    expected(0, 0)[0] = 255;
    EXPECT_EQ(cv::norm(seen.images[static_cast<std::size_t>(k)], expected, cv::NORM_INF), 0);
  }
}

TEST_F(RecordedScenario, OfAFisheyeThatIsGivenAsAPlainLensIsRefused) {
  draw(home() / "pictures", "{}.png");
  const std::string base = "path: pictures, fps: 10, focal: 100, speed: 0, distortion: ";
  for (const char* fisheye : {"[-0.002, 0.038, -0.036, 0.006, 0]", "[-0.9, 0, 0, 0, 0]"}) {
    EXPECT_NE(refusal(base + fisheye).find("distortion_model: equidistant"), std::string::npos)
        << fisheye;
  }
  playback(base + "[-0.28, 0.07, 0.0002, 0.00002, 0]");
  playback(base + "{equidistant: [-0.002, 0.038, -0.036, 0.006]}");
}

TEST_F(RecordedScenario, IsWhatReplayMakesOfItsOptions) {
  draw(home() / "pictures", "{}.png");
  const std::vector<std::string> options{"replay",   "pictures", "--fps",   "10",
                                         "--focal",  "300",      "--speed", "0.5",
                                         "--centre", "80,60",    "--set",   "circle.gap=0.3"};
  const auto lcs = [&](std::vector<std::string> arguments, std::vector<std::string> more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_lcs(arguments, {.folder = home()});
  };
  CommandResult result = lcs(options, {"--no-video", "--out", home() / "replayed"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  fs::create_directory(home() / "elsewhere");
  result = lcs(options, {"--write", home() / "elsewhere" / "mine.yaml"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  result =
      lcs({"run", home() / "elsewhere" / "mine.yaml"}, {"--no-video", "--out", home() / "run"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(test::read(home() / "replayed" / recording::kLayersFile),
            test::read(home() / "run" / recording::kLayersFile));
  result = lcs({"replay", "pictures"}, {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("(focal)"), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  result = lcs(options, {"--mask", "none.png"});
  EXPECT_NE(
      result.err.find("--mask: recording.mask: there is no file none.png; give its path from"),
      std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace lcs::replay
