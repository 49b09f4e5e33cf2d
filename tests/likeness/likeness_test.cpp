// Measures on pictures of which all is known, and `lcs likeness` from its command line to its
// files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "filter/detect/picture_noise.h"
#include "sim/random.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/csv.h"
#include "tools/likeness/measure.h"
#include "tools/likeness/page.h"

namespace lcs::likeness {
namespace {

namespace fs = std::filesystem;
const cv::Size kSize(320, 240);
constexpr int kThreshold = 20;

/// Grey squares of many sizes on grey, smooth enough that flow can follow them, moved by `shift`.
cv::Mat1b squares(cv::Point2d shift = {}) {
  sim::RandomStream random(5, "squares");
  cv::Mat1b picture(kSize, uchar{120});
  constexpr int kBits = 4;  // of a pixel's fraction
  const auto fixed = [](double v) { return static_cast<int>(std::lround(v * (1 << kBits))); };
  for (int i = 0; i < 220; ++i) {
    const double x = -40 + 400 * random.uniform() + shift.x;
    const double y = -40 + 320 * random.uniform() + shift.y;
    const double side = 6 + 14 * random.uniform(), grey = 40 + 170 * random.uniform();
    cv::rectangle(picture, {fixed(x), fixed(y)}, {fixed(x + side), fixed(y + side)}, grey,
                  cv::FILLED, cv::LINE_AA, kBits);
  }
  return picture;
}

void add_noise(cv::Mat1b& picture, double levels, std::string_view stream) {
  sim::RandomStream random(3, stream);
  for (uchar& pixel : picture) {
    pixel = cv::saturate_cast<uchar>(pixel + levels * random.normal());
  }
}

TEST(Noise, IsEstimatedWithinATenthOnFlatAndOnCrowdedPictures) {
  for (const double levels : {1.0, 2.0, 5.0, 12.0}) {
    cv::Mat1b slope(kSize);
    for (int x = 0; x < kSize.width; ++x) slope.col(x).setTo(60 + 0.25 * x);
    cv::Mat1b crowded = squares();
    crowded.rowRange(0, 80).setTo(140);  // a sky, which is all that can be judged
    for (cv::Mat1b picture : {slope, crowded}) {
      add_noise(picture, levels, "noise");
      const auto estimate = noise_levels(picture);
      ASSERT_TRUE(estimate);
      EXPECT_NEAR(*estimate, std::hypot(levels, 1 / std::sqrt(12.0)), 0.1 * levels);
    }
  }
}

TEST(Noise, IsUnknownWhereAllIsBlackOrWhite) {
  EXPECT_FALSE(noise_levels(cv::Mat1b(kSize, uchar{0})));
  EXPECT_FALSE(noise_levels(cv::Mat1b(kSize, uchar{255})));
  EXPECT_EQ(noise_levels(cv::Mat1b(kSize, uchar{90})), 0);
}

TEST(Measure, AKnownShiftGivesItsLengthAndDirection) {
  const cv::Point2d shift(4.5, -7.25);
  const Values v = measure(squares(), squares(shift), kThreshold);
  EXPECT_NEAR(*v[Measure::motion_px], cv::norm(shift), 0.1);
  EXPECT_NEAR(*v[Measure::direction_deg], std::atan2(shift.y, shift.x) * 180 / std::numbers::pi, 1);
  EXPECT_GT(*v[Measure::one_way], 0.95);
  EXPECT_NEAR(*v[Measure::outward], 0, 0.2);
  EXPECT_GT(*v[Measure::followed], 0.6);
}

TEST(Measure, WhatGrowsGoesOutwardAndNoOneWay) {
  const cv::Mat1b now = squares();
  const cv::Point2d middle(0.5 * (kSize.width - 1), 0.5 * (kSize.height - 1));
  cv::Mat1b next;
  cv::warpAffine(now, next, cv::getRotationMatrix2D(middle, 0, 1.05), kSize);
  const Values grows = measure(now, next, kThreshold), shrinks = measure(next, now, kThreshold);
  EXPECT_GT(*grows[Measure::outward], 0.9);
  EXPECT_LT(*shrinks[Measure::outward], -0.9);
  EXPECT_LT(*grows[Measure::one_way], 0.3);
}

TEST(Measure, ARepeatedPictureIsFoundAgainWholeAndBesideItByChance) {
  const cv::Mat1b picture = squares();
  const Values v = measure(picture, picture, kThreshold);
  EXPECT_EQ(v[Measure::found_again], 1);
  EXPECT_EQ(v[Measure::followed], 1);
  EXPECT_NEAR(*v[Measure::motion_px], 0, 1e-3);
  EXPECT_FALSE(v[Measure::direction_deg]);
  // Were corners spread evenly, so many places would have one within 2 px.
  const double evenly = 1 - std::exp(-std::numbers::pi * 4 * *v[Measure::corners_per_mpx] / 1e6);
  EXPECT_GT(*v[Measure::by_chance], 0.5 * evenly);
  EXPECT_LT(*v[Measure::by_chance], 2 * evenly);  // beside a corner there are more than elsewhere
}

TEST(Measure, NoiseTakesCornersAway) {
  cv::Mat1b one = squares(), other = squares();
  add_noise(one, 10, "one");
  add_noise(other, 10, "other");
  const Values v = measure(one, other, kThreshold);
  EXPECT_LT(*v[Measure::found_again], 0.9);
  EXPECT_GT(*v[Measure::found_again], *v[Measure::by_chance]);
}

TEST(Measure, SpacingAndContrastAreThoseOfAGridOfDots) {
  constexpr int kStep_px = 20, kContrast = 70;
  cv::Mat1b grid(kSize, uchar{100});
  for (int y = 10; y < kSize.height; y += kStep_px) {
    for (int x = 10; x < kSize.width; x += kStep_px) {
      grid(y, x) = 100 + kContrast;
    }
  }
  const Values v = measure(grid, grid, kThreshold);
  EXPECT_EQ(v[Measure::corners], (kSize.width / kStep_px) * (kSize.height / kStep_px));
  EXPECT_EQ(v[Measure::spacing_px], kStep_px);
  // a score is the highest threshold that is still passed, and a difference must exceed it
  EXPECT_EQ(v[Measure::contrast], kContrast - 1);
}

TEST(Measure, WithoutCornersThereIsNothingToTellOfThem) {
  const cv::Mat1b bare(kSize, uchar{100});
  const Values v = measure(bare, bare, kThreshold);
  EXPECT_EQ(v[Measure::corners], 0);
  EXPECT_FALSE(v[Measure::spacing_px] || v[Measure::motion_px] || v[Measure::found_again]);
}

TEST(Pairs, AreSpreadOverARunAndAllThereAreInAShortOne) {
  EXPECT_EQ(spread(101, 3), (std::vector<int>{0, 50, 99}));
  EXPECT_EQ(spread(4, 10), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(spread(1, 10).empty());
}

TEST(Groups, AllWorldsAreOneBesideTheirFamiliesAndARecordingOutsideIsMarked) {
  std::vector<Row> rows;
  for (int i = 0; i <= 10; ++i) {
    Row row{Origin::world, i % 2 ? "room" : "yard", fmt::format("{}", i), 0, {}};
    row.values[Measure::corners] = 100 + 10 * i;
    rows.push_back(row);
  }
  for (const double corners : {150, 500}) {
    Row row{Origin::recording, fmt::format("r{}", corners), "r", 0, {}};
    row.values[Measure::corners] = corners;
    rows.push_back(row);
  }
  const std::vector<Group> groups = groups_of(rows);
  ASSERT_EQ(groups.size(), 5u);
  EXPECT_EQ(groups[0].name, "worlds");
  EXPECT_EQ(groups[0].runs, 11u);
  EXPECT_EQ(groups[0].quantiles[0], (std::vector<double>{110, 125, 150, 175, 190}));
  EXPECT_TRUE(groups[0].quantiles[1].empty());
  EXPECT_EQ(groups[1].name, "yard");
  const std::string text = text_of(groups);
  EXPECT_NE(text.find(" 150 "), std::string::npos) << text;
  EXPECT_NE(text.find("*500"), std::string::npos) << text;
  EXPECT_EQ(text.find("*150"), std::string::npos) << text;
}

class LikenessCommand : public testing::Test {
 protected:
  bench::CommandResult run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "likeness");
    return bench::run_lcs(arguments, {.folder = folder_.path()});
  }
  void make_pictures(const std::string& name, int count) {
    fs::create_directories(folder_.path() / name);
    for (int i = 0; i < count; ++i) {
      cv::imwrite((folder_.path() / name / fmt::format("{}.png", i)).string(),
                  squares({3.0 * i, 0}));
    }
  }
  const bench::TemporaryFolder folder_;
};

TEST_F(LikenessCommand, MeasuresWorldsAndRecordingsAndWritesPageAndRows) {
  make_pictures("mine", 4);
  const auto result = run({"--worlds", "train", "--count", "1", "--family", "corridor", "--pairs",
                           "2", "--recording", "moves=mine", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const fs::path out = folder_.path() / "out" / "likeness";
  EXPECT_EQ(bench::entries(out), (std::set<std::string>{"likeness.csv", "page.html"}));
  std::istringstream lines(bench::read(out / "likeness.csv"));
  std::string head, line;
  std::getline(lines, head);
  const auto names = bench::fields_of(head);
  std::map<std::string, int> pairs;
  while (std::getline(lines, line)) {
    const auto fields = bench::fields_of(line);
    ASSERT_EQ(fields.size(), names.size()) << line;
    ++pairs[std::string(fields[1])];
    if (fields[1] != "moves") continue;
    const auto motion = std::find(names.begin(), names.end(), "motion_px") - names.begin();
    EXPECT_NEAR(bench::number_in<double>(fields[static_cast<std::size_t>(motion)]).value(), 3,
                0.05);
  }
  EXPECT_EQ(pairs, (std::map<std::string, int>{{"corridor", 2}, {"moves", 2}}));
}

TEST_F(LikenessCommand, MistakesAreToldInOneLineAndNothingIsWritten) {
  make_pictures("one", 1);
  fs::create_directory(folder_.path() / "broken");
  for (const char* name : {"1.png", "2.png"}) {
    std::ofstream(folder_.path() / "broken" / name) << "no picture";
  }
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& with) {
    const auto command = run(arguments);
    EXPECT_EQ(command.exit_code, 2);
    EXPECT_NE(command.err.find(with), std::string::npos) << command.err;
    EXPECT_EQ(std::count(command.err.begin(), command.err.end(), '\n'), 1) << command.err;
  };
  refused({"--quiet"}, "there is nothing to compare; give --worlds SPLIT, --suite");
  refused({"--quiet", "--recording", "a=missing"}, "missing");
  refused({"--quiet", "--recording", "missing"}, "--recording takes NAME=FOLDER");
  refused({"--quiet", "--recording", "a=one"}, "a has no two neighbouring pictures");
  refused({"--quiet", "--recording", "a=broken"}, "a has no two neighbouring pictures");
  refused({"--quiet", "--recording", "a=one", "--recording", "a=one"}, "one of that name");
  refused({"--worlds", "moon"}, "no split 'moon'");
  refused({"--count", "3"}, "--worlds");
  refused({"--suite", "--pairs", "0"}, "--pairs");
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

}  // namespace
}  // namespace lcs::likeness
