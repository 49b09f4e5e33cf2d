/// Each reason in the smallest situation that causes it. The camera is at rest unless stated, so a
/// static corner keeps its place.
#include "filter/types/reason.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <set>

#include "filter/paper/any_filter.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using testing::sparse_world;
using testing::steady_motion;
using testing::vga;
using testing::World;

using Corners = std::vector<Vector2f>;

constexpr double kDt_s = 0.1;

Corners operator+(Corners a, const Corners& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Corners shifted(Corners corners, double x) {
  for (Vector2f& corner : corners) corner.x() += static_cast<float>(x);
  return corners;
}

/// Irregular, so that only the true shift matches many of them.
const Corners kFive = {{200, 200}, {209, 197}, {204, 211}, {219, 206}, {213, 217}};

class Frames {
 public:
  explicit Frames(const char* preset_name) : Frames(preset(preset_name)) {}
  explicit Frames(const AnyParameters& parameters) : filter_(vga(), parameters) {}

  /// Runs the next frame. \return the reasons of its corners.
  std::vector<Reason> see(const Corners& corners, double dt_s = kDt_s, double speed_mps = 0) {
    const EgoMotion motion = steady_motion({0, 0, speed_mps}, Vector3d::Zero(), dt_s);
    const FrameResult& result = filter_.step(corners, motion);
    verdicts = result.verdicts;
    return result.reasons;
  }
  std::vector<Verdict> verdicts;

 private:
  AnyFilter filter_;
};

void expect_all(const Frames& frames, const std::vector<Reason>& reasons, std::size_t first,
                std::size_t last, Reason reason, Verdict verdict) {
  for (std::size_t i = first; i < last; ++i) {
    EXPECT_STREQ(text_of(reasons[i]).word, text_of(reason).word) << "corner " << i;
    EXPECT_EQ(frames.verdicts[i], verdict) << "corner " << i;
  }
}
void expect_all(const Frames& frames, const std::vector<Reason>& reasons, Reason reason,
                Verdict verdict) {
  expect_all(frames, reasons, 0, reasons.size(), reason, verdict);
}

TEST(Reasons, HaveAWordAndAMeaningOfTheirOwn) {
  std::set<std::string> words, meanings;
  for (const ReasonText& text : kReasons) {
    words.insert(text.word);
    meanings.insert(text.meaning);
  }
  EXPECT_EQ(words.size(), kReasons.size());
  EXPECT_EQ(meanings.size(), kReasons.size());
}

TEST(Reasons, OfAPlaceThatIsNotANumber) {
  for (const char* name : {"default", "lab"}) {
    Frames frames(name);
    expect_all(frames, frames.see({{std::numeric_limits<float>::quiet_NaN(), 3}}),
               Reason::not_finite, Verdict::pending);
  }
}

TEST(Reasons, OfCornersBeyondTheMostThatAreLookedAt) {
  Parameters p = Parameters{};
  p.line.max_corners = 1;
  Filter filter(testing::vga(), p);
  const Corners corners = {{600, 400}, {320, 240}, {10, 10}};
  const FrameResult& result = filter.step(corners, {});
  EXPECT_EQ(result.reasons[0], Reason::too_many);
  EXPECT_EQ(result.reasons[1], Reason::first_sighting);
  EXPECT_EQ(result.reasons[2], Reason::too_many);
}

TEST(Reasons, OfACornerInsideARegionThatIsNotLookedAt) {
  Frames frames("lab");
  const Corners wall = sparse_world(1, 20).corners();
  int inside = 0;
  for (int k = 0; k < 12; ++k) {
    const std::vector<Reason> reasons = frames.see(wall);
    for (std::size_t i = 0; i < reasons.size(); ++i) {
      EXPECT_EQ(reasons[i] == Reason::in_psi, frames.verdicts[i] == Verdict::ignored);
      inside += reasons[i] == Reason::in_psi;
    }
  }
  EXPECT_GT(inside, 0);
}

/// The reasons allowed with each verdict; a frame has no other pairs.
TEST(Reasons, GoWithTheirVerdicts) {
  const std::set<Reason> of_rebels = {Reason::rebel_edge, Reason::rebel_neighbours,
                                      Reason::inherited, Reason::alpha_third};
  const std::set<Reason> of_normals = {Reason::normal_edge, Reason::normal_neighbours, Reason::xi_2,
                                       Reason::xi_3};
  for (const std::string& name : preset_names()) {
    SCOPED_TRACE(name);
    World world = sparse_world(3, 14);
    for (std::size_t i = 0; i < world.points.size(); ++i) {
      if (i % 45 < 6 && i / 45 < 6) world.points[i].velocity_C = {0.9, 0.1, 0};
    }
    const EgoMotion motion = steady_motion({0, 0, 0.5}, {0.01, 0.05, 0}, kDt_s);
    AnyFilter filter(vga(), preset(name));
    int rebels = 0;
    for (int k = 0; k < 10; ++k) {
      world.advance(motion);
      const Corners corners = world.corners();
      const FrameResult& result = filter.step(corners, motion);
      ASSERT_EQ(result.reasons.size(), corners.size());
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Reason reason = result.reasons[i];
        SCOPED_TRACE(text_of(reason).word);
        rebels += result.verdicts[i] == Verdict::rebel;
        EXPECT_NE(reason, Reason::unknown);
        EXPECT_EQ(result.verdicts[i] == Verdict::rebel, of_rebels.contains(reason));
        EXPECT_EQ(result.verdicts[i] == Verdict::ignored, reason == Reason::in_psi);
        EXPECT_EQ(result.verdicts[i] == Verdict::normal, of_normals.contains(reason));
      }
    }
    EXPECT_GT(rebels, 0);
  }
}

// ---- Two hypotheses

TEST(HypothesisReasons, ACornerIsSeenOnceAndThenStandsOrMoves) {
  Frames frames("default");
  const Corners standing = shifted(kFive, -150);
  expect_all(frames, frames.see(kFive + standing), Reason::first_sighting, Verdict::pending);
  for (int k = 1; k < 4; ++k) frames.see(shifted(kFive, 8 * k) + standing);
  const auto reasons = frames.see(shifted(kFive, 32) + standing + Corners{{241, 204}, {500, 400}});
  expect_all(frames, reasons, 0, 5, Reason::rebel_edge, Verdict::rebel);
  expect_all(frames, reasons, 5, 10, Reason::normal_edge, Verdict::normal);
  expect_all(frames, reasons, 10, 11, Reason::inherited, Verdict::rebel);
  expect_all(frames, reasons, 11, 12, Reason::first_sighting, Verdict::pending);
}

// ---- The paper's rule

TEST(PaperReasons, ACornerAloneStartsARowOfAlphaAndIsMatchedThen) {
  Frames frames("lab");
  expect_all(frames, frames.see({{100, 100}}), Reason::alpha_first, Verdict::pending);
  expect_all(frames, frames.see({{100, 100}}), Reason::xi_2, Verdict::normal);
}

TEST(PaperReasons, ACornerOutsideTheSpanOfTheEdgeNearIt) {
  // Alpha reaches less far than mu; otherwise the corner would be the second of a row.
  AnyParameters parameters = preset("lab");
  set(parameters, "circle.alpha_reach", "5");
  Frames frames(parameters);
  frames.see({{100, 100}});
  expect_all(frames, frames.see({{100, 110}}), Reason::xi_5, Verdict::pending);
}

/// One edge 150 px right of the FOE, where a static point at the reference depth of 3 m moves 10 px
/// per frame: the camera moves 0.2 m. Alpha reaches only 1 px, so it has no effect.
class NearAnEdge : public ::testing::Test {
 protected:
  NearAnEdge() : frames_(with_short_alpha()) { frames_.see({at(0)}, 0.2, 1); }
  static AnyParameters with_short_alpha() {
    AnyParameters parameters = preset("lab");
    set(parameters, "circle.alpha_reach", "1");
    return parameters;
  }
  static Vector2f at(float ahead) {
    return vga().centre_px.cast<float>() + Vector2f(150 + ahead, 0);
  }
  void expect(float ahead, Reason reason, Verdict verdict) {
    expect_all(frames_, frames_.see({at(ahead)}, 0.2, 1), reason, verdict);
  }
  Frames frames_;
};

TEST_F(NearAnEdge, BeyondItsRadiusAtASpeedOfANearPointIsOne) {
  expect(10, Reason::xi_2, Verdict::normal);  // which halves mu
  expect(39, Reason::xi_1, Verdict::pending);
}
TEST_F(NearAnEdge, AtItsPredictionIsTwo) {
  expect(11, Reason::xi_2, Verdict::normal);
}
TEST_F(NearAnEdge, ShortOfItsPredictionIsThree) {
  expect(4, Reason::xi_3, Verdict::normal);
}
TEST_F(NearAnEdge, AgainstTheFieldIsFour) {
  expect(-4, Reason::xi_4, Verdict::pending);
}
TEST_F(NearAnEdge, TheSecondOfTwoThatFitIsOutbid) {
  const auto reasons = frames_.see({at(11), at(16)}, 0.2, 1);
  expect_all(frames_, reasons, 0, 1, Reason::xi_2, Verdict::normal);
  expect_all(frames_, reasons, 1, 2, Reason::outbid, Verdict::pending);
}

TEST(PaperReasons, ThreeSightingsInLineMakeARebelEdge) {
  Frames frames("lab");
  expect_all(frames, frames.see({{100, 100}}), Reason::alpha_first, Verdict::pending);
  expect_all(frames, frames.see({{120, 100}}), Reason::alpha_second, Verdict::pending);
  expect_all(frames, frames.see({{140, 100}}), Reason::alpha_third, Verdict::rebel);
  expect_all(frames, frames.see({{160, 100}}), Reason::rebel_edge, Verdict::rebel);
}

TEST(PaperReasons, AThirdSightingOffTheLineBreaksTheRow) {
  // 3 px from the line's prediction, and 22 deg off its direction.
  Frames frames("lab");
  frames.see({{100, 100}});
  frames.see({{104, 100}});
  expect_all(frames, frames.see({{107, 102.8f}}), Reason::alpha_bend, Verdict::pending);
}

TEST(PaperReasons, AThirdSightingWhereAStaticPointMayBeBreaksTheRow) {
  // Twice as fast as the reference: a point at half its depth. Edges with a reach of 5 px miss
  // it.
  AnyParameters parameters = preset("lab");
  set(parameters, "circle.mu_0", "5");
  Frames frames(parameters);
  const auto at = [](float ahead) {
    return Corners{vga().centre_px.cast<float>() + Vector2f(150 + ahead, 0)};
  };
  frames.see(at(0), 0.2, 1);
  frames.see(at(22), 0.2, 1);
  expect_all(frames, frames.see(at(46), 0.2, 1), Reason::alpha_on_field, Verdict::pending);
}

TEST(PaperReasons, ARowTakesOneThirdSighting) {
  Frames frames("lab");
  frames.see({{100, 100}});
  frames.see({{120, 100}});
  const auto reasons = frames.see({{140, 100}, {144, 100}});
  expect_all(frames, reasons, 0, 1, Reason::alpha_third, Verdict::rebel);
  expect_all(frames, reasons, 1, 2, Reason::alpha_taken, Verdict::pending);
}

TEST(PaperReasons, SightingsAtOneTimeAreNoRow) {
  Frames frames("lab");
  frames.see({{100, 100}});
  expect_all(frames, frames.see({{120, 100}}, 0), Reason::no_time, Verdict::pending);
}

}  // namespace
}  // namespace lcs
