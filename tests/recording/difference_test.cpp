// The first frame in which two recordings differ.
#include "tools/recording/difference.h"

#include <gtest/gtest.h>

#include "tests/tools/recordings.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"

namespace lcs::recording {
namespace {

class FirstDifference : public testing::Test {
 protected:
  /// Three frames of three corners at (10, 20), (30, 40) and (50, 60).
  static std::vector<FrameRecord> frames() {
    std::vector<FrameRecord> all;
    for (int k = 0; k < 3; ++k) {
      test::FrameMaker maker(k);
      for (int i = 0; i < 3; ++i) {
        maker.corner(Verdict::normal, sim::Label::fixed, 0, false,
                     Eigen::Vector2f(10 + 20 * i, 20 + 20 * i));
      }
      maker.record().reasons.assign(3, Reason::normal_edge);
      maker.record().log_odds.assign(3, -2.5F);
      all.push_back(maker);
    }
    return all;
  }
  Difference difference(const std::vector<FrameRecord>& before,
                        const std::vector<FrameRecord>& after) {
    return difference_of(written("before", before), written("after", after));
  }

 private:
  std::filesystem::path written(const char* name, const std::vector<FrameRecord>& frames) {
    const std::filesystem::path folder = folder_.path() / name;
    std::filesystem::create_directories(folder);
    RecordingWriter writer(folder, test::recording_of({}));
    for (const FrameRecord& frame : frames) writer.write(frame);
    writer.close();
    return folder;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(FirstDifference, EqualRecordingsHaveNone) {
  const Difference same = difference(frames(), frames());
  EXPECT_EQ(same.frames, 3);
  EXPECT_EQ(same.differing, 0);
  EXPECT_FALSE(same.first);
}

TEST_F(FirstDifference, NamesTheFrameTheColumnsAndTheCornersWithBothBeliefs) {
  std::vector<FrameRecord> after = frames();
  for (const std::size_t k : {1u, 2u}) {
    after[k].log_odds[0] = -2.25F;
    after[k].verdicts[2] = Verdict::rebel;
    after[k].reasons[2] = Reason::rebel_edge;
  }
  const Difference found = difference(frames(), after);
  EXPECT_EQ(found.differing, 2);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->frame, 1);
  EXPECT_EQ(found.first->t_ns, 100'000'000);
  EXPECT_EQ(found.first->parts, (std::vector<std::string>{"corners/reason/verdict", "log_odds"}));
  ASSERT_EQ(found.first->corners.size(), 2u) << "the corner in the middle is equal";
  const CornerDifference &first = found.first->corners[0], &second = found.first->corners[1];
  EXPECT_EQ(first.place_px, Eigen::Vector2f(50, 60)) << "another verdict comes first";
  EXPECT_EQ(first.before, "normal by normal_edge, log odds -2.50");
  EXPECT_EQ(first.after, "rebel by rebel_edge, log odds -2.50");
  EXPECT_EQ(second.place_px, Eigen::Vector2f(10, 20));
  EXPECT_EQ(second.after, "normal by normal_edge, log odds -2.25");
}

TEST_F(FirstDifference, ACornerOfOnlyOneSideHasOneBelief) {
  std::vector<FrameRecord> after = frames();
  after[0].corners_px[1].x() += 1;
  const Difference found = difference(frames(), after);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->parts, std::vector<std::string>{"corners/x"});
  ASSERT_EQ(found.first->corners.size(), 2u);
  EXPECT_EQ(found.first->corners[0].after, "no corner");
  EXPECT_EQ(found.first->corners[1].before, "no corner");
}

TEST_F(FirstDifference, AnOtherTruthAndAnOtherLayerAreNamed) {
  std::vector<FrameRecord> after = frames();
  after[2].corner_truth[0].depth_m = 3;
  after[2].layers.squares.emplace_back().id = 7;
  const Difference found = difference(frames(), after);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->frame, 2);
  EXPECT_EQ(found.first->parts, (std::vector<std::string>{"squares", "truth/corners/depth_m"}));
  EXPECT_TRUE(found.first->corners.empty());
}

TEST_F(FirstDifference, ARecordingThatEndsBeforeDiffersFromThere) {
  std::vector<FrameRecord> after = frames();
  after.pop_back();
  const Difference found = difference(frames(), after);
  EXPECT_EQ(found.frames, 3);
  EXPECT_EQ(found.differing, 1);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->frame, 2);
  EXPECT_EQ(found.first->parts, std::vector<std::string>{"frame"});
}

}  // namespace
}  // namespace lcs::recording
