// Rows of tables belong to pictures by the numbers in their names.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "scenarios/input/error.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;
using Numbers = std::vector<std::size_t>;
using test::refusal_of;
using test::write;

Numbers from_to(std::size_t first, std::size_t last) {
  Numbers numbers(last - first + 1);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

/// Times 0.1 s apart: row k has 0.1 k.
std::string times(int rows) {
  std::string text;
  for (int k = 0; k < rows; ++k) text += fmt::format("{:.1f}\n", 0.1 * k);
  return text;
}

/// Poses along z: row k is at 10 k^2 m.
std::string poses(int rows) {
  std::string text;
  for (int k = 0; k < rows; ++k) text += fmt::format("1 0 0 0 0 1 0 0 0 0 1 {}\n", 10 * k * k);
  return text;
}

class JoinedRows : public testing::Test {
 protected:
  void draw(const fs::path& folder, const Numbers& numbers, const char* name = "{:06}.png") {
    fs::remove_all(home_.path() / folder);
    for (const std::size_t number : numbers) {
      test::write_picture(home_.path() / folder / fmt::format(fmt::runtime(name), number),
                          cv::Mat1b(9, 12, uchar{0}));
    }
  }
  /// Of a folder of pictures, with a table of times or poses.
  Recorded read(const char* times, const char* poses, std::optional<double> fps = {}) {
    scenario::Scenario asked;
    asked.recording.emplace().path = home_.path() / "pictures";
    scenario::RecordingSource& source = *asked.recording;
    source.focal_px = Eigen::Vector2d(300, 300);
    if (times) source.times = home_.path() / times;
    if (poses) source.poses = home_.path() / poses;
    if (!poses) source.speed_mps = 1;
    source.fps = fps;
    return read_recorded(asked);
  }
  std::string refusal(const char* times, const char* poses, std::optional<double> fps = {}) {
    return refusal_of<std::runtime_error>([&] { read(times, poses, fps); });
  }
  const test::TemporaryFolder home_;
};

std::vector<std::int64_t> tenths(const Recorded& recorded) {
  std::vector<std::int64_t> times;
  for (const RecordedFrame& frame : recorded.frames) times.push_back(frame.t_ns / 100'000'000);
  return times;
}

void expect_told(const Recorded& recorded, const std::string& text) {
  const std::vector<std::string> lines = recorded.tally.lines();
  const bool is_told = std::ranges::any_of(
      lines, [&](const std::string& line) { return line.find(text) != line.npos; });
  EXPECT_TRUE(is_told) << text << "\n" << (lines.empty() ? "" : lines.front());
}

TEST_F(JoinedRows, OfKittiBelongToThePicturesOfTheirNumbers) {
  const fs::path drive = home_.path() / "07";
  write(drive / "calib.txt", "P0: 700 0 6 0 0 700 4 0 0 0 1 0\n");
  write(drive / "times.txt", times(10));
  write(drive / "poses.txt", poses(10));
  scenario::RecordingSource asked;
  asked.path = drive;
  for (const Numbers& numbers :
       {from_to(4, 9), Numbers{0, 1, 2, 4, 5, 6, 7, 8, 9}, from_to(1, 9)}) {
    draw("07/image_0", numbers);
    Recorded recorded = read_kitti_odometry(asked, false);
    ASSERT_EQ(recorded.frames.size(), numbers.size());
    recorded.motion->at(recorded.frames[0].t_ns);
    for (std::size_t i = 1; i < numbers.size(); ++i) {
      EXPECT_EQ(recorded.frames[i].t_ns, 100'000'000 * static_cast<std::int64_t>(numbers[i]));
      const EgoMotion motion = recorded.motion->at(recorded.frames[i].t_ns);
      const auto z = [](std::size_t k) { return 10.0 * static_cast<double>(k * k); };
      EXPECT_NEAR(motion.v_C_mps.z() * motion.dt_s, z(numbers[i]) - z(numbers[i - 1]), 1e-6);
    }
    expect_told(recorded, fmt::format("{} of the 10 rows of", numbers.size()));
  }
  draw("07/image_0", from_to(20, 25));
  EXPECT_NE(refusal_of<input::Error>([&] {
              read_kitti_odometry(asked, false);
            }).find("has 10 rows for 6 pictures, and none for the numbers 20 to 25"),
            std::string::npos);
}

TEST_F(JoinedRows, OfAFolderOfPicturesBelongToTheirNumbersWithWordsRoundThem) {
  write(home_.path() / "times.txt", times(10));
  write(home_.path() / "poses.txt", poses(10));
  for (const char* name : {"{:06}.png", "{}.png", "frame_{:04}.png", "cam0_{}_left.png"}) {
    draw("pictures", from_to(4, 9), name);
    const Recorded recorded = read("times.txt", "poses.txt");
    EXPECT_EQ(tenths(recorded), (std::vector<std::int64_t>{4, 5, 6, 7, 8, 9})) << name;
    expect_told(recorded, "6 of the 10 rows");
    expect_told(recorded, "by the numbers in their names: row 5 to");
  }
  draw("pictures", {0, 1, 3, 4});
  EXPECT_EQ(tenths(read("times.txt", "poses.txt")), (std::vector<std::int64_t>{0, 1, 3, 4}));
}

TEST_F(JoinedRows, AsManyAsPicturesBelongToThemInTheirOrder) {
  write(home_.path() / "times.txt", times(6));
  for (const Numbers& numbers :
       {from_to(0, 5), from_to(1, 6), from_to(20, 25), Numbers{0, 5, 10, 15, 20, 25}}) {
    draw("pictures", numbers);
    const Recorded recorded = read("times.txt", nullptr);
    EXPECT_EQ(tenths(recorded), (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
    expect_told(recorded, "6 of the 6 rows");
  }
}

TEST_F(JoinedRows, OfNumbersThatMayCountFromZeroOrOneAreRefused) {
  write(home_.path() / "times.txt", times(10));
  for (const Numbers& numbers : {from_to(1, 5), from_to(1, 9), from_to(4, 8)}) {
    draw("pictures", numbers);
    EXPECT_NE(refusal("times.txt", nullptr).find("which may count from 0 or from 1 by the numbers"),
              std::string::npos)
        << refusal("times.txt", nullptr);
  }
  draw("pictures", from_to(4, 10));  // the last picture has the last row
  EXPECT_EQ(tenths(read("times.txt", nullptr)).front(), 3);
}

TEST_F(JoinedRows, OfNamesWithoutOneNumberAreAsManyAsPictures) {
  write(home_.path() / "times.txt", times(3));
  for (const char* name : {"a", "b", "c", "d"}) {
    test::write_picture(home_.path() / "pictures" / fmt::format("{}.png", name),
                        cv::Mat1b(9, 12, uchar{0}));
  }
  EXPECT_NE(refusal("times.txt", nullptr)
                .find("has 3 rows for 4 pictures, whose names have no number that counts them"),
            std::string::npos);
  write(home_.path() / "kitti360.txt", "2 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_NE(refusal(nullptr, "kitti360.txt", 10).find("the names of the pictures have none"),
            std::string::npos);
}

TEST_F(JoinedRows, AreNeededForEachPicture) {
  write(home_.path() / "times.txt", times(3));
  draw("pictures", from_to(0, 3));
  EXPECT_NE(
      refusal("times.txt", nullptr).find("has 3 times for 4 pictures, and does not name them"),
      std::string::npos);
}

TEST_F(JoinedRows, ForANumberThatIsMissingTheTimeOfAPicturePasses) {
  draw("pictures", {3, 4, 6, 7});
  const Recorded recorded = read(nullptr, nullptr, 10);
  EXPECT_EQ(tenths(recorded), (std::vector<std::int64_t>{0, 1, 3, 4}));
  expect_told(recorded, "4 pictures have the numbers 3 to 7");
  draw("pictures", {0, 5, 10, 20});
  EXPECT_EQ(tenths(read(nullptr, nullptr, 10)), (std::vector<std::int64_t>{0, 1, 2, 4}));
  draw("pictures", {58, 59, 100, 101}, "IMG_20240102_{:06}.png");  // a time of day
  EXPECT_EQ(tenths(read(nullptr, nullptr, 10)), (std::vector<std::int64_t>{0, 1, 2, 3}));
  draw("pictures", {5, 1000, 70000});  // no count of pictures
  EXPECT_EQ(tenths(read(nullptr, nullptr, 10)), (std::vector<std::int64_t>{0, 1, 2}));
}

TEST_F(JoinedRows, OfThePartBeforeTheFirstPictureAreRefusedWhereAClockIsMissing) {
  std::string tum;
  for (int k = 0; k < 10; ++k) tum += fmt::format("{:.1f} 0 0 {} 0 0 0 1\n", 0.1 * k, k);
  write(home_.path() / "tum.txt", tum);
  draw("pictures", from_to(4, 9));
  EXPECT_NE(refusal(nullptr, "tum.txt", 10).find("may be at that picture or at number 0"),
            std::string::npos)
      << refusal(nullptr, "tum.txt", 10);
  draw("pictures", from_to(4, 12));  // poses of these pictures alone
  expect_told(read(nullptr, "tum.txt", 10), "is taken to be at the first picture, 000004.png");
}

}  // namespace
}  // namespace lcs::replay
