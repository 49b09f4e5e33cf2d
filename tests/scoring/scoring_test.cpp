#include "tools/scoring/scoring.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>

#include "tests/scoring/whole_recordings.h"
#include "tests/tools/recordings.h"
#include "tools/scoring/score_squares.h"

namespace lcs::scoring {
namespace {

using sim::Label;

double get(const Metrics& metrics, const std::string& name) {
  const std::optional<double> found = value(metrics, name);
  EXPECT_TRUE(found) << name << " is undefined";
  return found.value_or(-1);
}

bool is_undefined(const Metrics& metrics, const std::string& name) {
  return !value(metrics, name).has_value();
}

/// Frames 0 to count-1, each made by `fill`.
recording::Recording frames(int count, const std::function<void(test::FrameMaker&)>& fill) {
  std::vector<recording::FrameRecord> made;
  for (int k = 0; k < count; ++k) {
    test::FrameMaker frame(k);
    fill(frame);
    made.push_back(frame);
  }
  return test::recording_of(made);
}

constexpr test::PixelBox kBox{100, 100, 140, 150};

// ---- All metrics

TEST(Scoring, WithoutFramesOnlyCountsAreDefined) {
  for (const auto& [name, figure] : score(recording::Recording{})) {
    if (name == "frames" || name.starts_with("truth.")) {
      EXPECT_EQ(figure, 0) << name;
    } else {
      EXPECT_FALSE(figure) << name;
    }
  }
}

TEST(Scoring, AskingForAnUnknownMetricThrows) {
  EXPECT_THROW(value(score(recording::Recording{}), "rebel.f2"), std::out_of_range);
}

TEST(Scoring, CornersWithoutVerdictOrTruthAreRefused) {
  recording::Recording recording =
      frames(4, [](test::FrameMaker& frame) { frame.corners(3, Verdict::normal, Label::fixed); });
  recording::Recording without_verdict = recording;
  without_verdict.frames[2].verdicts.pop_back();
  EXPECT_THROW(score(without_verdict), std::invalid_argument);
  EXPECT_THROW(score_frames(without_verdict), std::invalid_argument);
  recording::Recording without_truth = recording;
  without_truth.frames[2].corner_truth.pop_back();
  EXPECT_THROW(score(without_truth), std::invalid_argument);
}

TEST(Scoring, TheOrderOfCornersObjectsAndSquaresDoesNotMatter) {
  recording::Recording recording = frames(8, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    frame.corners(k, Verdict::rebel, Label::rebel, 1)
        .corners(4, Verdict::pending, Label::rebel, 1, true)
        .corners(2, Verdict::rebel, Label::fixed, 2)
        .corners(5, Verdict::normal, Label::fixed, 2)
        .corner(Verdict::rebel, Label::indistinct, 1)
        .object(1, kBox, true)
        .object(2, {100, 110, 140, 160}, false)
        .square(4, kBox)
        .square(5, {102, 105, 142, 155})
        .square(6, {300, 300, 330, 330})
        .rebel_circle({200, 200}, 5)
        .rebel_circle({120, 120}, 5);
  });
  const Metrics before = score(recording);
  for (recording::FrameRecord& frame : recording.frames) {
    std::reverse(frame.corners_px.begin(), frame.corners_px.end());
    std::reverse(frame.verdicts.begin(), frame.verdicts.end());
    std::reverse(frame.corner_truth.begin(), frame.corner_truth.end());
    std::reverse(frame.object_truth.begin(), frame.object_truth.end());
    std::reverse(frame.layers.squares.begin(), frame.layers.squares.end());
    std::reverse(frame.layers.rebel_circles.begin(), frame.layers.rebel_circles.end());
  }
  EXPECT_EQ(before, score(recording));
}

// ---- Rebel corners

TEST(RebelCorners, APerfectDetectorScoresOne) {
  const Metrics metrics = score(frames(10, [](test::FrameMaker& frame) {
    frame.corners(5, Verdict::rebel, Label::rebel, 1)
        .corners(3, Verdict::rebel, Label::rebel, 1, true)
        .corners(20, Verdict::normal, Label::fixed)
        .object(1, kBox, true)
        .square(1, kBox);
  }));
  for (const char* name :
       {"rebel.precision", "rebel.recall", "rebel.f1", "rebel.precision_distinct",
        "rebel.recall_distinct", "rebel.f1_distinct", "rebel.recall_radial", "rebel.object_recall",
        "square.recall_30", "square.recall_50", "square.recall_70", "square.precision_30",
        "square.precision_50", "square.precision_70", "square.mean_iou"}) {
    EXPECT_DOUBLE_EQ(get(metrics, name), 1) << name;
  }
  EXPECT_EQ(get(metrics, "rebel.false_objects_per_100_frames"), 0);
  EXPECT_EQ(get(metrics, "square.identity_switches"), 0);
}

TEST(RebelCorners, ADetectorThatCallsEverythingRebelHasThePrecisionOfChance) {
  // After 3 frames of warm-up 7 remain: 7 * 5 rebels among 7 * (5 + 15).
  const Metrics metrics = score(frames(10, [](test::FrameMaker& frame) {
    frame.corners(5, Verdict::rebel, Label::rebel, 1).corners(15, Verdict::rebel, Label::fixed);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision"), 0.25);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.f1"), 2 * 0.25 / 1.25);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.false_corners_per_frame"), 15);
  EXPECT_DOUBLE_EQ(get(metrics, "truth.rebel_corners"), 35);
  EXPECT_DOUBLE_EQ(get(metrics, "truth.fixed_corners"), 105);
}

TEST(RebelCorners, TheWarmUpIsLeftOut) {
  // All verdicts wrong before frame 3, correct from then on.
  const Metrics metrics = score(frames(6, [](test::FrameMaker& frame) {
    const bool warm = frame.record().index >= 3;
    frame.corners(4, warm ? Verdict::rebel : Verdict::normal, Label::rebel, 1)
        .corners(4, warm ? Verdict::normal : Verdict::rebel, Label::fixed);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall"), 1);
}

TEST(RebelCorners, IndistinctOnesAndNoLandmarksAreLeftOutWhateverIsSaidOfThem) {
  const auto common = [](test::FrameMaker& frame) {
    frame.corners(3, Verdict::rebel, Label::rebel, 1)
        .corners(1, Verdict::normal, Label::rebel, 1)
        .corners(1, Verdict::rebel, Label::fixed);
  };
  const Metrics without = score(frames(6, common));
  const Metrics with = score(frames(6, [&](test::FrameMaker& frame) {
    common(frame);
    for (const Verdict verdict : {Verdict::rebel, Verdict::normal}) {
      frame.corners(9, verdict, Label::indistinct, 1).corners(9, verdict, Label::none, -1);
    }
  }));
  for (const auto& [name, figure] : without) {
    if (name.starts_with("rebel.") || name.starts_with("truth.")) {
      EXPECT_EQ(figure, value(with, name)) << name;
    }
  }
}

TEST(RebelCorners, PendingAndIgnoredOnesCountAsMissed) {
  const Metrics metrics = score(frames(4, [](test::FrameMaker& frame) {
    frame.corners(1, Verdict::rebel, Label::rebel, 1)
        .corners(1, Verdict::pending, Label::rebel, 1)
        .corners(1, Verdict::ignored, Label::rebel, 1)
        .corners(1, Verdict::normal, Label::rebel, 1);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall"), 0.25);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision"), 1);
}

TEST(RebelCorners, RecallBeginsThreeFramesAfterAnObjectsFirstRebelAndPrecisionAtOnce) {
  // The object starts at frame 5: 5 to 7 are excused, 8 and 9 are not.
  const recording::Recording recording = frames(10, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    const Label label = k >= 5 ? Label::rebel : Label::fixed;
    frame.corner(k == 6 || k == 9 ? Verdict::rebel : Verdict::pending, label, 1);
  });
  const Metrics metrics = score(recording);
  EXPECT_DOUBLE_EQ(get(metrics, "truth.rebel_corners"), 2);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall"), 0.5);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision"), 1);

  const std::vector<RebelCounts> counts = score_frames(recording);
  EXPECT_EQ(counts[6].true_rebels, 1);
  EXPECT_EQ(counts[6].found_rebels, 0);
  EXPECT_FALSE(counts[6].recall());
  EXPECT_EQ(counts[8].missed_rebels, 1);
  EXPECT_EQ(counts[9].found_rebels, 1);
}

TEST(RebelCorners, EachObjectHasItsOwnFirstFrame) {
  // Object 1 is distinct from the start; object 2 from frame 6 on and never excused by object 1.
  const Metrics metrics = score(frames(10, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    frame.corner(Verdict::rebel, Label::rebel, 1);
    if (k >= 6) frame.corner(Verdict::normal, Label::rebel, 2);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "truth.rebel_corners"), 7 + 1);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall"), 7.0 / 8);
}

TEST(RebelCorners, RadialOnesAreInTheOverallFiguresAndNotInTheDistinctOnes) {
  const Metrics metrics = score(frames(4, [](test::FrameMaker& frame) {
    frame.corners(3, Verdict::rebel, Label::rebel, 1)
        .corners(1, Verdict::normal, Label::rebel, 1)
        .corners(1, Verdict::rebel, Label::rebel, 1, true)
        .corners(3, Verdict::normal, Label::rebel, 1, true)
        .corners(1, Verdict::rebel, Label::fixed);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall"), 4.0 / 8);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision"), 4.0 / 5);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall_distinct"), 3.0 / 4);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision_distinct"), 3.0 / 4);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.f1_distinct"), 3.0 / 4);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall_radial"), 1.0 / 4);
  EXPECT_DOUBLE_EQ(get(metrics, "truth.radial_corners"), 4);
}

TEST(RebelCorners, FixedOnesAtOutlinesAreLeftOutOfTheClearFiguresAlone) {
  const Metrics metrics = score(frames(4, [](test::FrameMaker& frame) {
    frame.corners(3, Verdict::rebel, Label::rebel, 1)
        .corners(1, Verdict::normal, Label::rebel, 1)
        .corners(3, Verdict::rebel, Label::fixed)
        .corners(1, Verdict::normal, Label::fixed);
    auto& truth = frame.record().corner_truth;
    truth[4].outline = truth[5].outline = truth[7].outline = true;
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision"), 3.0 / 6);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision_distinct"), 3.0 / 6);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.f1"), 3.0 / 5);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision_clear"), 3.0 / 4);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.f1_clear"), 3.0 / 4);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.false_corners_per_frame"), 3);
  EXPECT_DOUBLE_EQ(get(metrics, "truth.fixed_corners"), 4);
}

TEST(RebelCorners, EachKindOfErrorCostsWhatRightVerdictsOnItWouldGain) {
  // Half of 8 rebels are found; 3 calls are false: precision 4/7, recall 4/8, F1 8/15.
  const auto maker = [](bool with_reasons) {
    return [=](test::FrameMaker& frame) {
      frame.corners(4, Verdict::rebel, Label::rebel, 1)
          .corners(2, Verdict::normal, Label::rebel, 1, true)
          .corners(1, Verdict::pending, Label::rebel, 1)
          .corners(1, Verdict::normal, Label::rebel, 1)
          .corners(3, Verdict::rebel, Label::fixed);
      auto& record = frame.record();
      record.corner_truth[8].outline = true;
      if (!with_reasons) return;
      record.reasons.assign(11, Reason::normal_edge);
      record.reasons[6] = Reason::first_sighting;
      record.reasons[8] = record.reasons[9] = Reason::inherited;
    };
  };
  const Metrics metrics = score(frames(4, maker(true)));
  const double f1 = 8.0 / 15;
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.f1"), f1);
  EXPECT_NEAR(get(metrics, "rebel.f1_lost_outline"), 8.0 / 14 - f1, 1e-12);
  EXPECT_NEAR(get(metrics, "rebel.f1_lost_radial"), 12.0 / 17 - f1, 1e-12);
  // One missed rebel, and of the two inherited ones the one at no outline.
  EXPECT_NEAR(get(metrics, "rebel.f1_lost_first_seen"), 10.0 / 15 - f1, 1e-12);
  EXPECT_NEAR(get(metrics, "rebel.f1_lost_tracked"), 10.0 / 15 - f1, 1e-12);

  const Metrics untold = score(frames(4, maker(false)));
  EXPECT_NEAR(get(untold, "rebel.f1_lost_radial"), 12.0 / 17 - f1, 1e-12);
  EXPECT_FALSE(value(untold, "rebel.f1_lost_first_seen"));
  EXPECT_FALSE(value(untold, "rebel.f1_lost_tracked"));
}

TEST(RebelCorners, WithoutRebelsInTheTruthRecallIsUndefinedAndFalseOnesStillShow) {
  const Metrics metrics = score(frames(8, [](test::FrameMaker& frame) {
    frame.corners(2, Verdict::rebel, Label::fixed).corners(8, Verdict::normal, Label::fixed);
  }));
  EXPECT_TRUE(is_undefined(metrics, "rebel.recall"));
  EXPECT_TRUE(is_undefined(metrics, "rebel.f1"));
  EXPECT_TRUE(is_undefined(metrics, "rebel.recall_radial"));
  EXPECT_TRUE(is_undefined(metrics, "rebel.object_recall"));
  EXPECT_TRUE(is_undefined(metrics, "rebel.latency_frames_median"));
  EXPECT_TRUE(is_undefined(metrics, "rebel.precision")) << "so that means are over scenes with F1";
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.false_corners_per_frame"), 2);
}

TEST(RebelCorners, ADetectorThatSaysNothingHasAPrecisionAndAnF1OfZero) {
  const Metrics metrics = score(frames(
      8, [](test::FrameMaker& frame) { frame.corners(5, Verdict::normal, Label::rebel, 1); }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.precision"), 0);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.recall"), 0);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.f1"), 0);
}

TEST(RebelCorners, TheCountsOfFramesAddUpToTheFiguresOfTheRun) {
  const recording::Recording recording = frames(20, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    frame.corners(k % 4, Verdict::rebel, Label::rebel, 1)
        .corners(k % 3, Verdict::normal, Label::rebel, 1)
        .corners(k % 5, Verdict::rebel, Label::fixed);
  });
  RebelCounts sum;
  for (const RebelCounts& counts : score_frames(recording)) sum += counts;
  const Metrics metrics = score(recording);
  EXPECT_EQ(sum.precision(), value(metrics, "rebel.precision"));
  EXPECT_EQ(sum.recall(), value(metrics, "rebel.recall"));
  EXPECT_EQ(sum.f1(), value(metrics, "rebel.f1"));
}

// ---- Rebel objects

TEST(RebelObjects, AnObjectIsFoundByThreeRebelsAndLatencyCountsFromItsFirstFrame) {
  // Distinct from frame 4; two rebels on it at 5 and 6 are too few, three at 7 suffice.
  const Metrics metrics = score(frames(12, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    const Label label = k >= 4 ? Label::rebel : Label::fixed;
    const int rebels = k < 5 ? 0 : k < 7 ? 2 : 3;
    frame.corners(rebels, Verdict::rebel, label, 1).corners(4 - rebels, Verdict::pending, label, 1);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "truth.rebel_objects"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.object_recall"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.latency_frames_median"), 3);
}

TEST(RebelObjects, TheFloorOfLatencyIsReachedByAnObjectDistinctFromTheFirstFrame) {
  const Metrics metrics = score(frames(6, [](test::FrameMaker& frame) {
    const Verdict verdict = frame.record().index >= 2 ? Verdict::rebel : Verdict::pending;
    frame.corners(3, verdict, Label::rebel, 1);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.latency_frames_median"), recording::kSightings - 1);
}

TEST(RebelObjects, RebelsOnAnObjectBeforeItMovesDoNotFindIt) {
  const Metrics metrics = score(frames(12, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    frame.corners(5, k < 6 ? Verdict::rebel : Verdict::normal, k < 6 ? Label::fixed : Label::rebel,
                  1);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.object_recall"), 0);
  EXPECT_TRUE(is_undefined(metrics, "rebel.latency_frames_median"));
}

TEST(RebelObjects, AnObjectThatIsDistinctTooBrieflyToBeFoundIsLeftOut) {
  const auto distinct_for = [](int length) {
    return score(frames(12, [=](test::FrameMaker& frame) {
      const int k = frame.record().index;
      const bool distinct = k >= 5 && k < 5 + length;
      frame.corners(5, Verdict::normal, distinct ? Label::rebel : Label::indistinct, 1);
    }));
  };
  EXPECT_TRUE(is_undefined(distinct_for(2), "rebel.object_recall"));
  EXPECT_DOUBLE_EQ(get(distinct_for(3), "rebel.object_recall"), 0);
}

TEST(RebelObjects, LatencyIsTheMedianOfThoseFound) {
  const Metrics metrics = score(frames(20, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    const auto seen_from = [&](int object, int first) {
      frame.corners(3, k >= first ? Verdict::rebel : Verdict::pending, Label::rebel, object);
    };
    seen_from(1, 2);
    seen_from(2, 7);
    seen_from(3, 4);
    seen_from(4, 1000);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.object_recall"), 0.75);
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.latency_frames_median"), 4);
}

TEST(RebelObjects, ACircleIsFalseUnlessAMovingCornerIsInItOrItsCentreInAMoversBox) {
  const auto false_objects = [](Vec2 centre, double radius, bool moving) {
    return get(score(frames(7,
                            [&](test::FrameMaker& frame) {
                              frame.object(1, kBox, moving)
                                  .corner(Verdict::normal, Label::indistinct, 1, false, {138, 148})
                                  .corner(Verdict::normal, Label::fixed, 0, false, {200, 148})
                                  .rebel_circle(centre, radius);
                            })),
               "rebel.false_objects_per_100_frames");
  };
  EXPECT_DOUBLE_EQ(false_objects({120, 120}, 1, true), 0) << "centre in the box";
  EXPECT_DOUBLE_EQ(false_objects({120, 120}, 1, false), 100) << "of an object at rest";
  EXPECT_DOUBLE_EQ(false_objects({150, 148}, 12.1, true), 0) << "a moving corner on its rim";
  EXPECT_DOUBLE_EQ(false_objects({150, 148}, 11.9, true), 100) << "that corner just outside";
  EXPECT_DOUBLE_EQ(false_objects({200, 148}, 5, true), 100) << "only a fixed corner in it";
}

TEST(RebelObjects, CircleRecallIsTheShareOfMoversSeenWithACirclesCentreInTheirBox) {
  // Detected or not in frames 3 to 7; all are detected before.
  const auto recall = [](int corners, bool moving,
                         const std::function<void(test::FrameMaker&)>& circles) {
    return value(score(frames(8,
                              [&](test::FrameMaker& frame) {
                                frame.object(1, kBox, moving)
                                    .corners(corners, Verdict::rebel, Label::rebel, 1)
                                    .corners(9, Verdict::rebel, Label::rebel, 2)
                                    .corners(9, Verdict::normal, Label::rebel, 1);
                                circles(frame);
                              })),
                 "rebel.circle_recall");
  };
  const auto from = [](int first, Vec2 centre) {
    return [=](test::FrameMaker& frame) {
      if (frame.record().index >= first) frame.rebel_circle(centre, 5).rebel_circle(centre, 5);
    };
  };
  EXPECT_DOUBLE_EQ(recall(3, true, from(0, {120, 120})).value(), 1);
  EXPECT_DOUBLE_EQ(recall(3, true, from(6, {120, 120})).value(), 2.0 / 5);
  EXPECT_DOUBLE_EQ(recall(3, true, from(0, {97, 120})).value(), 0) << "its disc alone reaches in";
  EXPECT_FALSE(recall(2, true, from(0, {120, 120}))) << "too few corners to be seen by";
  EXPECT_FALSE(recall(3, false, from(0, {120, 120}))) << "at rest";
}

TEST(RebelObjects, FalseCirclesAreCountedPerHundredFramesAfterTheWarmUp) {
  const Metrics metrics = score(frames(8, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    if (k < 3 || k == 4) frame.rebel_circle({50, 50}, 5).rebel_circle({60, 60}, 5);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "rebel.false_objects_per_100_frames"), 100 * 2.0 / 5);
}

// ---- Squares

/// Score of four frames, of which only the last counts.
Metrics score_one(const std::function<void(test::FrameMaker&)>& fill) {
  return score(frames(4, fill));
}

TEST(Squares, IntersectionOverUnionIsTakenInPixelEdges) {
  // A box of 40 x 50 pixels, and a square shifted by 8 columns: (32 * 50) / (48 * 50).
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 2)
        .object(2, kBox, false)
        .square(1, {108, 100, 148, 150});
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.mean_iou"), 32.0 / 48);
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_30"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_70"), 0);
  EXPECT_DOUBLE_EQ(get(metrics, "square.precision_50"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.precision_70"), 0);
}

TEST(Squares, ThresholdsAreInclusive) {
  // Exactly half of the box.
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 2)
        .object(2, kBox, false)
        .square(1, {100, 100, 120, 150});
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.mean_iou"), 0.5);
}

TEST(Squares, MeanIouIsOfPairsMatchedAtOneHalf) {
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 1)
        .corners(4, Verdict::normal, Label::fixed, 2)
        .object(1, kBox, false)
        .object(2, {300, 100, 340, 150}, false)
        .square(1, kBox)
        .square(2, {316, 100, 356, 150});  // 24 / 56
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.mean_iou"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_30"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50"), 0.5);
}

struct Eligibility {
  const char* what;
  test::PixelBox box;
  int corners;
  double visible_fraction;
  bool eligible;
};

class SquareEligibility : public testing::TestWithParam<Eligibility> {};

TEST_P(SquareEligibility, DecidesWhetherABoxCounts) {
  const Eligibility& given = GetParam();
  const Metrics metrics = score_one([&](test::FrameMaker& frame) {
    frame.corners(given.corners, Verdict::normal, Label::fixed, 2)
        .object(2, given.box, false, given.visible_fraction);
  });
  EXPECT_DOUBLE_EQ(get(metrics, "truth.boxes"), given.eligible ? 1 : 0);
  EXPECT_DOUBLE_EQ(get(metrics, "truth.objects"), 1);
  EXPECT_EQ(value(metrics, "square.recall_50").has_value(), given.eligible);
}

INSTANTIATE_TEST_SUITE_P(
    Bounds, SquareEligibility,
    testing::Values(Eligibility{"all at their bounds", {100, 100, 120, 120}, 4, 0.5, true},
                    Eligibility{"too small", {100, 100, 121, 119}, 4, 0.5, false},
                    Eligibility{"too few corners", {100, 100, 120, 120}, 3, 0.5, false},
                    Eligibility{"too much hidden", {100, 100, 120, 120}, 4, 0.49, false}),
    [](const auto& test) {
      std::string name = test.param.what;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

TEST(Squares, ASquareOnAnObjectThatIsNotEligibleIsNeitherRightNorWrong) {
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 2)
        .object(2, kBox, false)
        .object(1, {300, 100, 340, 150}, true, 0.2)  // mostly occluded
        .square(1, kBox)
        .square(2, {300, 100, 340, 150});
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.precision_50"), 1);
}

TEST(Squares, ASquareFarFromTheObjectThatIsNotEligibleIsWrong) {
  // An IoU of 24 / 56: at 0.3 it matches the occluded object, at 0.5 nothing.
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 2)
        .object(2, kBox, false)
        .object(1, {300, 100, 340, 150}, true, 0.2)
        .square(1, kBox)
        .square(2, {316, 100, 356, 150});
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.precision_30"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.precision_50"), 0.5);
}

TEST(Squares, ASecondSquareOnOneObjectIsWrong) {
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 2)
        .object(2, kBox, false)
        .square(1, kBox)
        .square(2, {102, 100, 142, 150});
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.precision_50"), 0.5);
  EXPECT_DOUBLE_EQ(get(metrics, "square.mean_iou"), 1) << "the better one is taken";
}

TEST(Squares, MatchingIsGreedyByIou) {
  // The square lies on object 2 (IoU 1) and also overlaps object 1; greedy matching takes the best
  // pair first and leaves object 1 unmatched.
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 1)
        .corners(4, Verdict::normal, Label::fixed, 2)
        .object(1, {104, 100, 144, 150}, false)
        .object(2, kBox, false)
        .square(1, kBox);
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50"), 0.5);
  EXPECT_DOUBLE_EQ(get(metrics, "square.mean_iou"), 1);
}

TEST(Squares, WithoutSquaresRecallIsZeroAndPrecisionUndefined) {
  const Metrics metrics = score_one([](test::FrameMaker& frame) {
    frame.corners(4, Verdict::normal, Label::fixed, 2).object(2, kBox, false);
  });
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50"), 0);
  EXPECT_TRUE(is_undefined(metrics, "square.precision_50"));
  EXPECT_TRUE(is_undefined(metrics, "square.mean_iou"));
}

TEST(Squares, WithoutObjectsEverySquareIsWrongAndRecallUndefined) {
  const Metrics metrics = score_one([](test::FrameMaker& frame) { frame.square(1, kBox); });
  EXPECT_TRUE(is_undefined(metrics, "square.recall_50"));
  EXPECT_TRUE(is_undefined(metrics, "square.identity_switches"));
  EXPECT_DOUBLE_EQ(get(metrics, "square.precision_50"), 0);
}

TEST(Squares, MoversAndStaticObjectsAreScoredApartByWhatTheyDoInTheWholeRun) {
  // Object 1 moves only in frame 0, but counts as a mover for the whole run.
  const Metrics metrics = score(frames(5, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    frame.corners(4, Verdict::normal, Label::fixed, 1)
        .corners(4, Verdict::normal, Label::fixed, 2)
        .object(1, kBox, k == 0)
        .object(2, {300, 100, 340, 150}, false)
        .square(2, {308, 100, 348, 150});
    if (k == 4) frame.square(1, kBox);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50_movers"), 0.5);
  EXPECT_DOUBLE_EQ(get(metrics, "square.recall_50_static"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.mean_iou_movers"), 1);
  EXPECT_DOUBLE_EQ(get(metrics, "square.mean_iou_static"), 32.0 / 48);
}

TEST(Squares, AnIdentitySwitchIsAnotherSquareOnTheSameObjectAlsoAfterAGap) {
  // Ids on object 2: 1 1 - 1 5 5 - 8 from frame 3 on.
  const std::vector<int> ids{1, 1, 0, 1, 5, 5, 0, 8};
  const Metrics metrics = score(frames(11, [&](test::FrameMaker& frame) {
    const int k = frame.record().index;
    frame.corners(4, Verdict::normal, Label::fixed, 2).object(2, kBox, false);
    const int id = k < 3 ? 99 : ids[static_cast<std::size_t>(k - 3)];
    if (id > 0) frame.square(static_cast<Id>(id), kBox);
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "square.identity_switches"), 2);
}

// ---- Size, ego-motion, time

TEST(Dimensions, AreCountedBesideStoresOfCorners) {
  // 1, 2, .. 10 corners; each frame has one square more than the one before.
  const Metrics metrics = score(frames(10, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    frame.corners(k + 1, Verdict::normal, Label::fixed);
    for (int i = 0; i <= k; ++i) frame.square(static_cast<Id>(i), kBox);
    frame.rebel_circle({1, 1}, 1);
    frame.record().layers.normal_edges.resize(2);
    frame.record().paper.ignored.resize(50);     // no part of the paper's dimensionality
    frame.record().paper.collectors.resize(50);  // nor are these
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "frames"), 10);
  EXPECT_DOUBLE_EQ(get(metrics, "dimension.corners_mean"), 5.5);
  EXPECT_DOUBLE_EQ(get(metrics, "dimension.mean"), 5.5 + 1 + 2);
  EXPECT_DOUBLE_EQ(get(metrics, "dimension.max"), 13);
  // Stored: 1 3 6 10 15 20 25 30 35 40; 1 3 6 10 15 21 28 36 44 52; 1 3 6 .. 55.
  EXPECT_DOUBLE_EQ(get(metrics, "dimension.five_frame_mean"), 18.5);
  EXPECT_DOUBLE_EQ(get(metrics, "dimension.eight_frame_mean"), 21.6);
  EXPECT_DOUBLE_EQ(get(metrics, "dimension.accumulative"), 22);
  EXPECT_DOUBLE_EQ(get(metrics, "dimension.accumulative_final"), 55);
}

TEST(Edges, AreRematchedWhereTheSameOneHasACornerInTheNextFrame) {
  // Ids 1 2 3 in every frame; 3 never has a corner, and 2 has none in the last frame.
  const Metrics metrics = score(frames(3, [](test::FrameMaker& frame) {
    const int k = frame.record().index;
    for (const Id id : {1u, 2u, 3u}) {
      Edge edge;
      edge.id = id;
      edge.corner = id == 3 || (id == 2 && k == 2) ? -1 : 0;
      frame.record().layers.normal_edges.push_back(edge);
    }
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "edges.rematched"), 3.0 / 6);
}

TEST(EgoMotionError, IsTheAngleAndSpeedBetweenWhatWasToldAndWhatWasTrue) {
  const Metrics metrics = score(frames(5, [](test::FrameMaker& frame) {
    recording::FrameRecord& record = frame.record();
    record.motion.dt_s = record.true_motion.dt_s = record.index > 0 ? 0.1 : 0;
    record.true_motion.R_cur_prev = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()).matrix();
    record.motion.R_cur_prev = Eigen::AngleAxisd(0.203, Eigen::Vector3d::UnitY()).matrix();
    record.true_motion.v_C_mps = {0, 0, 0.5};
    record.motion.v_C_mps = {0.03, 0, 0.54};
  }));
  EXPECT_NEAR(get(metrics, "ego.rotation_error_mrad_median"), 3, 1e-9);
  EXPECT_NEAR(get(metrics, "ego.velocity_error_mps_median"), 0.05, 1e-12);
}

TEST(Times, AreQuantilesOverFramesAndRatiosToFastOnTheSameFrame) {
  const Metrics metrics = score(frames(3, [](test::FrameMaker& frame) {
    const double k = frame.record().index;
    recording::FrameTimes times;
    times.detect_ms = 1 + k;        // 1, 2, 3
    times.describe_ms = 2 * k;      // 0, 2, 4
    times.line_ms = 4 - k;          // 4, 3, 2: ratios 4, 1.5, 0.67
    times.filter_ms = 10 * k;       // 0, 10, 20
    times.simulate_ms = 7 - 2 * k;  // total (7 + 5 + 3) + (1 + 2 + 3) + 6 + 30 + 9 = 66 ms
    times.truth_ms = 3;
    frame.record().times = times;
  }));
  EXPECT_DOUBLE_EQ(get(metrics, "time.detect_ms_median"), 2);
  EXPECT_DOUBLE_EQ(get(metrics, "time.describe_ms_median"), 2);
  EXPECT_DOUBLE_EQ(get(metrics, "time.line_ms_median"), 3);
  EXPECT_DOUBLE_EQ(get(metrics, "time.line_over_fast"), 1.5);
  EXPECT_DOUBLE_EQ(get(metrics, "time.filter_ms_p99"), 10 + 0.98 * 10);
  EXPECT_DOUBLE_EQ(get(metrics, "sim.frames_per_second"), 3 / 0.066);
}

TEST(Times, OfARecordingWithoutThemAreUndefined) {
  const Metrics metrics = score(
      frames(5, [](test::FrameMaker& frame) { frame.corners(3, Verdict::normal, Label::fixed); }));
  for (const auto& [name, figure] : metrics) {
    if (name.starts_with("time.") || name.starts_with("sim.")) {
      EXPECT_FALSE(figure) << name;
    }
  }
}

}  // namespace
}  // namespace lcs::scoring
