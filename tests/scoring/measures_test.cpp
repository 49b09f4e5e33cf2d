// The measures of the literature, on inputs whose values follow from their definitions. A long test
// compares them with the libraries (field_measures.sh).

#include "tools/scoring/score_movers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "tests/scoring/whole_recordings.h"
#include "tests/tools/recordings.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {
namespace {

// ---- Pairs

double sum_of(const std::vector<std::pair<int, int>>& pairs, const Eigen::MatrixXd& worth) {
  return std::accumulate(pairs.begin(), pairs.end(), 0.0, [&](double sum, const auto& pair) {
    return sum + worth(pair.first, pair.second);
  });
}

/// The greatest sum over all orders of the longer side.
double greatest_sum(const Eigen::MatrixXd& worth) {
  if (worth.rows() > worth.cols()) return greatest_sum(worth.transpose());
  std::vector<int> order(worth.cols());
  std::iota(order.begin(), order.end(), 0);
  double greatest = -1e9;
  do {
    double sum = 0;
    for (Eigen::Index i = 0; i < worth.rows(); ++i) sum += worth(i, order[i]);
    greatest = std::max(greatest, sum);
  } while (std::ranges::next_permutation(order).found);
  return greatest;
}

TEST(BestPairs, HaveTheGreatestSumOfAllAssignments) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (const auto& [rows, columns] : {std::pair(1, 1), {1, 5}, {5, 1}, {4, 4}, {3, 6}, {6, 3}}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::MatrixXd worth =
          Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(random); });
      const auto pairs = best_pairs(worth);
      EXPECT_EQ(std::ssize(pairs), std::min(rows, columns));
      EXPECT_NEAR(sum_of(pairs, worth), greatest_sum(worth), 1e-12);
    }
  }
  EXPECT_TRUE(best_pairs(Eigen::MatrixXd(0, 4)).empty());
  EXPECT_TRUE(best_pairs(Eigen::MatrixXd(4, 0)).empty());
}

// ---- Tracks

/// A frame with one object, and one track that overlaps with it by `iou`.
FrameBoxes one(int track, double iou = 1) {
  return {{0}, {track}, Eigen::MatrixXd::Constant(1, 1, iou)};
}

TEST(TrackMeasures, OfRightTracksAreOne) {
  const std::vector<FrameBoxes> frames(10, one(4));
  const TrackMeasures measures = measure_tracks(frames);
  EXPECT_DOUBLE_EQ(measures.hota, 1);
  EXPECT_DOUBLE_EQ(measures.mota, 1);
  EXPECT_DOUBLE_EQ(measures.idf1, 1);
  EXPECT_EQ(measures.identity_changes, 0);
}

TEST(TrackMeasures, OfATrackThatIsRenamedHalfwayAre) {
  std::vector<FrameBoxes> frames(5, one(0));
  frames.insert(frames.end(), 5, one(1));
  const TrackMeasures measures = measure_tracks(frames);
  EXPECT_DOUBLE_EQ(measures.detection, 1);
  EXPECT_DOUBLE_EQ(measures.association, 0.5);  // 5 of the 10 frames of the object, for each match
  EXPECT_DOUBLE_EQ(measures.hota, std::sqrt(0.5));
  EXPECT_EQ(measures.identity_changes, 1);
  EXPECT_DOUBLE_EQ(measures.mota, 0.9);
  EXPECT_DOUBLE_EQ(measures.idf1, 0.5);
}

TEST(TrackMeasures, HotaCountsTheThresholdsThatTheOverlapReaches) {
  const std::vector<FrameBoxes> frames(4, one(0, 0.62));
  EXPECT_NEAR(measure_tracks(frames).hota, 12.0 / 19, 1e-12);  // .05 to .60
  EXPECT_DOUBLE_EQ(measure_tracks(frames).mota, 1);            // .5 is reached
  EXPECT_DOUBLE_EQ(measure_tracks(std::vector<FrameBoxes>(4, one(0, 0.45))).mota, -1);
}

TEST(TrackMeasures, FaultsLowerMota) {
  std::vector<FrameBoxes> frames(8, one(0));
  frames.push_back({{0}, {}, Eigen::MatrixXd(1, 0)});     // missed
  frames.push_back({{}, {7, 8}, Eigen::MatrixXd(0, 2)});  // two false ones
  const TrackMeasures measures = measure_tracks(frames);
  EXPECT_NEAR(measures.mota, 1 - 3.0 / 9, 1e-12);
  EXPECT_NEAR(measures.detection, 8.0 / 11, 1e-12);
  EXPECT_NEAR(measures.idf1, 2 * 8.0 / 19, 1e-12);
}

TEST(TrackMeasures, MotaKeepsThePairOfTheFrameBeforeThoughAnotherOverlapsMore) {
  const Eigen::MatrixXd other_is_nearer = (Eigen::MatrixXd(1, 2) << 0.6, 0.9).finished();
  const std::vector<FrameBoxes> frames{one(0), {{0}, {0, 1}, other_is_nearer}};
  EXPECT_EQ(measure_tracks(frames).identity_changes, 0);
}

// ---- Average precision

TEST(AveragePrecision, IsOneWhereAllRightOnesComeFirst) {
  const std::vector<Found> curve{{1, 0}, {2, 0}, {2, 1}, {2, 5}};
  EXPECT_DOUBLE_EQ(average_precision(curve, 2), 1);
}

TEST(AveragePrecision, IsTheMeanOverRecalls) {
  // Precision 1 at the 51 recalls up to .5, then .5 at best at the other 50.
  const std::vector<Found> curve{{1, 0}, {1, 1}, {1, 2}, {2, 2}};
  EXPECT_NEAR(average_precision(curve, 2), (51 + 50 * 0.5) / 101, 1e-12);
}

TEST(AveragePrecision, CountsWhatIsNeverFound) {
  EXPECT_NEAR(average_precision(std::vector<Found>{{1, 0}}, 4), 26.0 / 101, 1e-12);  // 0 to .25
  EXPECT_DOUBLE_EQ(average_precision({}, 4), 0);
}

// ---- Boundaries

cv::Mat1b square_at(int x, int y) {
  cv::Mat1b mask(100, 120, std::uint8_t{0});
  mask(cv::Rect(x, y, 30, 20)) = 255;
  return mask;
}

TEST(BoundaryF, IsOneWithinTheReachAndZeroBeyond) {
  EXPECT_DOUBLE_EQ(boundary_f(square_at(20, 20), square_at(20, 20), 0), 1);
  EXPECT_DOUBLE_EQ(boundary_f(square_at(20, 20), square_at(22, 22), 3), 1);
  EXPECT_DOUBLE_EQ(boundary_f(square_at(20, 20), square_at(80, 60), 3), 0);
  const double between = boundary_f(square_at(20, 20), square_at(24, 20), 3);
  EXPECT_GT(between, 0.5);  // the long sides meet
  EXPECT_LT(between, 1);    // the short ones do not
}

TEST(BoundaryF, OfAnEmptyMaskIsZeroOfTwoOne) {
  const cv::Mat1b empty(100, 120, std::uint8_t{0});
  EXPECT_EQ(boundary_f(empty, square_at(20, 20), 3), 0);
  EXPECT_EQ(boundary_f(empty, empty, 3), 1);
}

// ---- Of a recording

constexpr test::PixelBox kBox{100, 100, 140, 150};
constexpr test::PixelBox kOther{300, 100, 340, 150};

/// Frames in which object 1 moves and has four rebel corners in its box.
recording::Recording with_a_mover(int count, const std::function<void(test::FrameMaker&)>& fill) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < count; ++k) {
    test::FrameMaker frame(k);
    for (int i = 0; i < 4; ++i) {
      frame.corner(Verdict::rebel, sim::Label::rebel, 1, false,
                   {110, 110 + 5 * static_cast<float>(i)});
    }
    frame.object(1, kBox, true).full();
    fill(frame);
    frames.push_back(frame);
  }
  recording::Recording recording = test::recording_of(frames);
  recording.camera.emplace();
  recording.camera->width_px = 640;
  recording.camera->height_px = 480;
  return recording;
}

double get(const Metrics& metrics, const std::string& name) {
  const std::optional<double> found = value(metrics, name);
  EXPECT_TRUE(found) << name << " is undefined";
  return found.value_or(-1);
}

TEST(Movers, ThatAreBoxedRightHaveFullMarks) {
  const Metrics metrics = score(with_a_mover(8, [](test::FrameMaker& frame) {
    if (frame.record().index >= 5) frame.square(9, kBox);
  }));
  // Frames 3 to 7 count, of which the last three have the box.
  EXPECT_DOUBLE_EQ(get(metrics, "mover.detection_rate"), 0.6);
  EXPECT_DOUBLE_EQ(get(metrics, "mover.hota_detection"), 0.6);
  EXPECT_DOUBLE_EQ(get(metrics, "mover.region_j"), 0.6);
  EXPECT_DOUBLE_EQ(get(metrics, "mover.pixel_iou"), 0.6);
  EXPECT_DOUBLE_EQ(get(metrics, "mover.boundary_f"), 0.6);
  EXPECT_DOUBLE_EQ(get(metrics, "mover.latency_ms_median"), 500);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.latency_ms_median"), 0);
  EXPECT_FALSE(value(metrics, "mover.false_per_minute"));   // something moves in each frame
  EXPECT_FALSE(value(metrics, "mover.average_precision"));  // no log odds
}

TEST(Movers, ThatRestAgainNeedNoBoxAndForgiveOne) {
  const auto rests = [](test::FrameMaker& frame) {
    if (frame.record().index >= 6) frame.record().object_truth[0].moving = false;
    frame.square(9, kBox);
  };
  const Metrics metrics = score(with_a_mover(10, rests));
  EXPECT_DOUBLE_EQ(get(metrics, "mover.hota"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "mover.false_per_minute"), 0);
}

TEST(Movers, ThatAreNoneAreFalseOncePerIdentity) {
  const Metrics metrics = score(with_a_mover(13, [](test::FrameMaker& frame) {
    frame.record().object_truth[0].moving = false;
    frame.square(frame.record().index < 8 ? 1 : 2, kOther);
  }));
  EXPECT_FALSE(value(metrics, "mover.hota"));
  // Two identities in the ten intervals of 0.1 s up to the frames 3 to 12.
  EXPECT_NEAR(get(metrics, "mover.false_per_minute"), 120, 1e-9);
}

TEST(Movers, AreRankedByTheLogOddsOfTheirCorners) {
  const auto with_odds = [](float of_false) {
    return [of_false](test::FrameMaker& frame) {
      frame.corner(Verdict::rebel, sim::Label::fixed, 0, false, {320, 120});
      frame.record().log_odds = {2, 2, 2, 2, of_false};
      frame.square(1, kBox).square(2, kOther);
    };
  };
  const Metrics right = score(with_a_mover(9, with_odds(1)));
  EXPECT_DOUBLE_EQ(get(right, "mover.average_precision"), 1);
  EXPECT_DOUBLE_EQ(get(right, "rebel.average_precision"), 1);
  const Metrics wrong = score(with_a_mover(9, with_odds(3)));
  EXPECT_DOUBLE_EQ(get(wrong, "mover.average_precision"), 0.5);  // each false box comes before
  // The six fixed corners come before the rebels that recall counts, four in each of six frames.
  EXPECT_NEAR(get(wrong, "rebel.average_precision"), 24.0 / 30, 1e-12);
}

/// A square covers the truth except a corner of 19 + .. + 1 pixels, unless it has a mask of its
/// own.
TEST(Movers, AreJudgedByThePixelsOfOutlinesOrMasks) {
  const auto outlined = [](test::FrameMaker& frame) {
    frame.record().object_truth.clear();
    frame.object(1, {100, 100, 140, 140}, true).full().square(9, {100, 100, 140, 140});
    Outline& outline = frame.record().layers.squares.back().outline;
    const std::array<Vec2, 5> rim{Vec2(100, 100), Vec2(139, 100), Vec2(139, 139), Vec2(119, 139),
                                  Vec2(100, 120)};
    outline.count = static_cast<int>(rim.size());
    std::ranges::copy(rim, outline.places.begin());
  };
  const Metrics metrics = score(with_a_mover(6, outlined));
  EXPECT_NEAR(get(metrics, "mover.region_j"), 1 - 190 / 1600.0, 1e-12);
  EXPECT_NEAR(get(metrics, "mover.pixel_iou"), 1 - 190 / 1600.0, 1e-12);
  EXPECT_DOUBLE_EQ(get(metrics, "mover.hota"), 1);  // by boxes
  const Metrics by_mask = score(with_a_mover(6, [&](test::FrameMaker& frame) {
    outlined(frame);
    frame.record().masks[9] = {cv::Rect(100, 100, 40, 40), {0, 1200, 400}};
  }));
  EXPECT_NEAR(get(by_mask, "mover.region_j"), 0.75, 1e-12);
}

TEST(Movers, HaveNoPixelsWithoutMasksOrPicture) {
  recording::Recording recording =
      with_a_mover(6, [](test::FrameMaker& frame) { frame.square(9, kBox); });
  recording::Recording without_masks = recording;
  without_masks.frames[5].object_truth[0].mask.clear();
  without_masks.frames[0].object_truth[0].mask.clear();
  EXPECT_FALSE(value(score(without_masks), "mover.region_j"));
  recording.camera.reset();
  EXPECT_FALSE(value(score(recording), "mover.boundary_f"));
}

}  // namespace
}  // namespace lcs::scoring
