#include "tools/suite/tables.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/files.h"
#include "tests/tools/suites.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/output_file.h"
#include "tools/scoring/events.h"

namespace lcs::suite {
namespace {

namespace fs = std::filesystem;

/// A false alarm of static corners.
scoring::ScoredEvent false_alarm(int first_frame, int corners, const std::string& picture) {
  scoring::ScoredEvent event;
  event.kind = scoring::EventKind::false_alarm;
  event.first_frame = first_frame;
  event.last_frame = first_frame + 4;
  event.corners = corners;
  event.views = {{.frame = first_frame + 2,
                  .t_s = 0.1 * first_frame,
                  .centre_px = {50, 50},
                  .half_size_px = {10, 10},
                  .jpeg_base64 = scoring::base64(picture)}};
  return event;
}

/// A suite of one scenario and one seed, whose run has these events.
class MergeRequest : public testing::Test {
 protected:
  SuiteResult suite(const std::string& name, std::vector<std::optional<double>> f1,
                    const std::vector<scoring::ScoredEvent>& events) const {
    SuiteResult suite = suite_with({scenario_with("near|by", "rebel.f1", f1)});
    for (RunResult& run : suite.scenarios.front().runs) {
      run.folder = fs::path("runs") / std::to_string(run.seed);
      fs::create_directories(home_.path() / name / run.folder);
      scoring::write_events(home_.path() / name / run.folder / scoring::kEventsFile,
                            run.seed == 2 ? events : std::vector<scoring::ScoredEvent>{}, {});
    }
    return suite;
  }
  /// The Markdown.
  std::string written(const SuiteResult& before, const SuiteResult& after,
                      const std::string& pictures_at = "") const {
    const Comparison comparison = compare(before, after, [](std::string_view) { return true; });
    fs::create_directory(home_.path() / "out");
    const SuiteInFolder then{before, home_.path() / "before"}, now{after, home_.path() / "after"};
    write_merge_request(home_.path() / "out", then, now, comparison,
                        verdict_of(now, &then, &comparison), pictures_at);
    return test::read(home_.path() / "out" / kSummaryFile);
  }
  std::string picture(const char* name) const { return test::read(home_.path() / "out" / name); }
  bool has(const char* name) const { return fs::exists(home_.path() / "out" / name); }

  const test::TemporaryFolder home_;
  const std::vector<std::optional<double>> good_{0.80, 0.81, 0.82}, bad_{0.50, 0.51, 0.52};
};

TEST_F(MergeRequest, SaysTheVerdictAndShowsTheEventThatGrewMostOnBothSides) {
  const auto before =
      suite("before", good_, {false_alarm(10, 8, "small"), false_alarm(40, 90, "x")});
  const auto after = suite("after", bad_, {false_alarm(12, 60, "large"), false_alarm(40, 95, "x")});
  const std::string text = written(before, after);
  EXPECT_TRUE(text.starts_with("### 🔴 Regressed\n")) << text;
  // By 52 corners; the other event is larger, but grew by 5
  EXPECT_NE(text.find("near\\|by seed 2, frames 12 to 16"), text.npos) << text;
  EXPECT_NE(text.find("60 corners (before: 8)"), text.npos) << text;
  EXPECT_NE(text.find("| ![frame 12](before.jpg) | ![frame 14](after.jpg) |"), text.npos) << text;
  EXPECT_EQ(picture(kBeforePicture), "small");
  EXPECT_EQ(picture(kAfterPicture), "large");
  EXPECT_NE(text.find("| 0.810 | 0.510 | -0.300 | regressed |"), text.npos) << text;
}

TEST_F(MergeRequest, SaysThatAnEventIsNewAndThatPicturesAreNotKept) {
  auto plain = false_alarm(10, 8, "");
  const auto before = suite("before", good_, {});
  const auto after = suite("after", good_, {plain});
  const std::string text = written(before, after);
  EXPECT_TRUE(text.starts_with("### 🟢 Equal\n")) << text;
  EXPECT_NE(text.find("| no such event in these frames | the suite keeps no pictures |"), text.npos)
      << text;
  EXPECT_FALSE(has(kBeforePicture) || has(kAfterPicture));
}

TEST_F(MergeRequest, IsYellowWhereALossIsNotExcluded) {
  const std::string text = written(suite("before", good_, {}), suite("after", {0.7, 0.9, 0.8}, {}));
  EXPECT_TRUE(text.starts_with("### 🟡 No regression found\n")) << text;
}

TEST_F(MergeRequest, IsRedWhereASeedIsMissing) {
  const std::string text = written(suite("before", good_, {}), suite("after", {0.80, 0.81}, {}));
  EXPECT_TRUE(text.starts_with("### 🔴 Not judged\n")) << text;
}

TEST_F(MergeRequest, LooksForPicturesAtTheAddressThatIsGiven) {
  const auto before = suite("before", good_, {false_alarm(10, 8, "small")});
  const auto after = suite("after", bad_, {false_alarm(10, 9, "large")});
  for (const char* address : {"https://host/pictures", "https://host/pictures/"}) {
    EXPECT_NE(written(before, after, address).find("(https://host/pictures/after.jpg)"),
              std::string::npos);
  }
}

TEST_F(MergeRequest, HasNoEventWhereNoneGrew) {
  const auto before = suite("before", good_, {false_alarm(10, 8, "small")});
  const auto after = suite("after", good_, {false_alarm(11, 8, "small")});
  EXPECT_EQ(written(before, after).find("grew"), std::string::npos);
}

}  // namespace
}  // namespace lcs::suite
