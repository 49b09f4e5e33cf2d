// The results of a run take no more memory the longer it is.
#include "tools/output/result.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <set>

#include "tests/tools/recordings.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::output {
namespace {

constexpr int kCorners = 500;

/// A mover that is missed and a wall of which some corners are called rebels, in each frame.
recording::FrameRecord frame_of(int index) {
  test::FrameMaker frame(index);
  frame.object(1, {100, 100, 160, 160}, true);
  for (int i = 0; i < kCorners; ++i) {
    const Eigen::Vector2f px(static_cast<float>(i % 25), static_cast<float>(i / 25));
    const bool is_mover = i < 10;
    frame.corner(i % 10 == 0 ? Verdict::rebel : Verdict::normal,
                 is_mover ? sim::Label::rebel : sim::Label::fixed, is_mover ? 1 : 0, false,
                 is_mover ? Eigen::Vector2f(110 + px.x(), 110)
                          : Eigen::Vector2f(300 + 5 * px.x(), 5 * px.y()));
    frame.record().reasons.push_back(Reason::normal_edge);
    frame.record().layers.normal_edges.emplace_back().corner = i;
  }
  frame.square(index, {400, 300, 460, 360}).rebel_circle({430, 330}, 20);
  frame.record().signatures.resize(kCorners);
  frame.record().true_motion.dt_s = 0.1;
  frame.record().times.emplace().detect_ms = 1;
  return frame;
}

std::size_t heap_bytes() {
  const auto heap = ::mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

TEST(Result, KeepsNumbersOfALateFrameAndNotTheFrame) {
  const test::TemporaryFolder folder;
  ResultOptions options;
  options.events = true;
  Result result(folder.path() / "run", test::recording_of({}), {640, 480}, options);
  const cv::Mat3b image(480, 640, cv::Vec3b(90, 90, 90));
  const auto add = [&](int first, int end) {
    for (int k = first; k < end; ++k) result.add(frame_of(k), image);
  };
  constexpr int kFirst = kMostHeld + 20, kAll = kFirst + 140;
  add(0, kFirst);
  const std::size_t before = heap_bytes();
  add(kFirst, kAll);
  const auto per_frame =
      (static_cast<double>(heap_bytes()) - static_cast<double>(before)) / (kAll - kFirst);
  const std::size_t without_frame = heap_bytes();
  const recording::FrameRecord kept = frame_of(kAll);
  if (heap_bytes() == without_frame) GTEST_SKIP() << "this build's heap is not glibc's";
  // Some 120 bytes of figures and 100 for each of the errors, twice for vectors that grow.
  EXPECT_LT(per_frame, 2000);
  EXPECT_GT(heap_bytes() - without_frame, 50'000u) << "which a frame takes";
  const scoring::Metrics metrics = result.finish(std::nullopt);
  EXPECT_EQ(scoring::value(metrics, "frames"), kAll);
  std::set<scoring::EventFamily> families;
  for (const scoring::ScoredEvent& event :
       scoring::read_events(result.output().staging() / scoring::kEventsFile)) {
    families.insert(scoring::family_of(event.kind));
  }
  EXPECT_EQ(families.size(), 3u) << "errors of rebels, circles and squares were found";
}

}  // namespace
}  // namespace lcs::output
