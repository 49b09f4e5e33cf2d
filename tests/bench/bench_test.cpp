#include "tools/bench/bench.h"

#include <gtest/gtest.h>

#include <chrono>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "filter/detect/describe.h"
#include "scenarios/load.h"
#include "tests/bench/recorded_run.h"
#include "tools/bench/timed.h"
#include "tools/scoring/scoring.h"

namespace lcs::bench {
namespace {

/// A minimal detector: it calls every corner a rebel and stores its inputs.
class Alarmist : public Detector {
 public:
  const FrameResult& step(const DetectorInput& input) override {
    images_.push_back(input.image.clone());
    motions_.push_back(input.motion);
    signatures_.emplace_back(input.signatures.begin(), input.signatures.end());
    result_.verdicts.assign(input.corners_px.size(), Verdict::rebel);
    result_.times.line_ms = 1.25;
    return result_;
  }
  const std::vector<cv::Mat3b>& images() const { return images_; }
  const std::vector<EgoMotion>& motions() const { return motions_; }
  const std::vector<std::vector<Signature>>& signatures() const { return signatures_; }
  bool wants_signatures() const override { return wants_signatures_; }
  void want_signatures() { wants_signatures_ = true; }

 private:
  bool wants_signatures_ = false;
  FrameResult result_;
  std::vector<cv::Mat3b> images_;
  std::vector<EgoMotion> motions_;
  std::vector<std::vector<Signature>> signatures_;
};

constexpr int kFrames = 6;

class BenchTest : public testing::Test {
 protected:
  scenario::Scenario scenario_ =
      scenario::load(LCS_SCENARIOS_DIR "/crossing.yaml", {.sets = {"frames=6"}, .seed = {}});
  sim::Simulation simulation_{scenario_};
  Alarmist detector_;
  recording::Recording recording_{run_info(scenario_, simulation_), {}};
};

TEST_F(BenchTest, RunsAnyDetectorThroughTheWholeLoop) {
  int seen = 0;
  run_into(recording_, scenario_, simulation_, detector_,
           [&](const recording::FrameRecord& frame, const cv::Mat3b& image) {
             EXPECT_EQ(frame.index, seen);
             EXPECT_EQ(image.size(),
                       cv::Size(scenario_.camera.width_px, scenario_.camera.height_px));
             ++seen;
           });
  EXPECT_EQ(seen, kFrames);
  ASSERT_EQ(recording_.frames.size(), std::size_t{kFrames});
  EXPECT_EQ(recording_.scenario, "crossing");
  EXPECT_EQ(recording_.objects.size(), simulation_.objects().size());
  for (int k = 0; k < kFrames; ++k) {
    const recording::FrameRecord& frame = recording_.frames[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame.t_ns, k * std::int64_t{100'000'000});
    EXPECT_EQ(frame.verdicts.size(), frame.corners_px.size());
    EXPECT_EQ(frame.corner_truth.size(), frame.corners_px.size());
    EXPECT_EQ(frame.motion.v_C_mps, detector_.motions()[static_cast<std::size_t>(k)].v_C_mps);
    EXPECT_EQ(frame.times.value().line_ms, 1.25);
    EXPECT_GT(frame.times.value().detect_ms, 0);
  }
  // The rover drives at 0.5 m/s along the optical axis; the IMU estimates it to a few per cent.
  EXPECT_NEAR(recording_.frames.back().motion.v_C_mps.z(), 0.5, 0.05);
  EXPECT_NEAR(recording_.frames.back().true_motion.v_C_mps.z(), 0.5, 0.005);
  EXPECT_FALSE(std::equal(detector_.images()[0].begin(), detector_.images()[0].end(),
                          detector_.images()[1].begin()))
      << "the world stood still";
}

TEST_F(BenchTest, SignaturesAreMadeOnceForThoseWhoWantThemAndForNobodyElse) {
  Alarmist other;
  detector_.want_signatures();
  recording::Recording of_other;
  const auto into = [](recording::Recording& recording) {
    return [&](const recording::FrameRecord& frame, const cv::Mat3b&) {
      recording.frames.push_back(frame);
    };
  };
  const DetectorRun both[] = {{detector_, into(recording_)}, {other, into(of_other)}};
  run(scenario_, simulation_, both);
  for (std::size_t k = 0; k < recording_.frames.size(); ++k) {
    const recording::FrameRecord &frame = recording_.frames[k], &without = of_other.frames[k];
    cv::Mat1b grey;
    cv::cvtColor(detector_.images()[k], grey, cv::COLOR_BGR2GRAY);
    ASSERT_FALSE(frame.corners_px.empty());
    EXPECT_EQ(frame.signatures, describe(grey, frame.corners_px));
    EXPECT_EQ(detector_.signatures()[k], frame.signatures);
    EXPECT_GT(frame.times.value().describe_ms, 0);
    EXPECT_EQ(without.corners_px, frame.corners_px);
    EXPECT_TRUE(without.signatures.empty());
    EXPECT_TRUE(other.signatures()[k].empty());
    EXPECT_EQ(without.times.value().describe_ms, 0);
  }
}

TEST_F(BenchTest, AnAlarmistMissesNothingAndHasThePrecisionOfChance) {
  run_into(recording_, scenario_, simulation_, detector_);
  const scoring::Metrics metrics = scoring::score(recording_);
  EXPECT_EQ(scoring::value(metrics, "rebel.recall"), 1);
  EXPECT_EQ(scoring::value(metrics, "rebel.object_recall"), 1);
  int rebels = 0, fixed = 0;
  for (const recording::FrameRecord& frame : recording_.frames) {
    if (frame.index < recording::kSightings) continue;
    for (const sim::CornerTruth& truth : frame.corner_truth) {
      rebels += truth.label == sim::Label::rebel;
      fixed += truth.label == sim::Label::fixed;
    }
  }
  EXPECT_GT(rebels, 0);
  EXPECT_GT(fixed, 0);
  EXPECT_DOUBLE_EQ(scoring::value(metrics, "rebel.precision").value(),
                   static_cast<double>(rebels) / (rebels + fixed));
}

TEST_F(BenchTest, ExceptionOfTheSinkEndsTheRun) {
  const auto stop_at_2 = [](const recording::FrameRecord& frame, const cv::Mat3b&) {
    if (frame.index == 2) throw std::runtime_error("enough");
  };
  EXPECT_THROW(run_into(recording_, scenario_, simulation_, detector_, stop_at_2),
               std::runtime_error);
  EXPECT_EQ(recording_.frames.size(), 3u);
}

/// Runs `for_each_frame` on five frames. \return the frames that were worked on, and its error.
std::pair<std::vector<int>, std::string> worked_on(int threads, int unmade, int unworkable) {
  std::vector<int> worked;
  int k = 0;
  const auto make = [&]() -> std::optional<InputFrame> {
    if (k == unmade) throw std::runtime_error("making " + std::to_string(k));
    if (k == 5) return std::nullopt;
    InputFrame seen;
    seen.record.index = k++;
    return seen;
  };
  const auto work = [&](InputFrame& seen) {
    if (seen.record.index == unworkable) {
      throw std::runtime_error("working on " + std::to_string(unworkable));
    }
    worked.push_back(seen.record.index);
  };
  try {
    for_each_frame(make, work, threads);
  } catch (const std::runtime_error& error) {
    return {worked, error.what()};
  }
  return {worked, ""};
}

TEST(ForEachFrame, TwoThreadsEndWithTheErrorOfOneThread) {
  constexpr int kNever = -1;
  for (int unmade = kNever; unmade <= 5; ++unmade) {
    for (int unworkable = kNever; unworkable < 5; ++unworkable) {
      EXPECT_EQ(worked_on(2, unmade, unworkable), worked_on(1, unmade, unworkable))
          << "frame " << unmade << " is not made, " << unworkable << " is not worked on";
    }
  }
  EXPECT_EQ(worked_on(2, kNever, kNever), (std::pair{std::vector{0, 1, 2, 3, 4}, std::string()}));
  EXPECT_EQ(worked_on(2, 3, 2).second, "working on 2") << "before frame 3 would be made";
}

/// A camera that drives past a wall of noise: no simulation, so that the thread sanitizer sees
/// every thread.
class Wall : public FrameSource {
 public:
  bool next(recording::FrameRecord& frame, cv::Mat3b& image) override {
    constexpr int kLength = 8, kStep_px = 4;
    if (k_ == kLength) return false;
    cv::cvtColor(noise_.colRange(kStep_px * k_, kStep_px * k_ + kCamera.width_px), image,
                 cv::COLOR_GRAY2BGR);
    frame.index = k_;
    frame.motion.dt_s = k_ > 0 ? 0.1 : 0;
    frame.motion.v_C_mps = {1, 0, 0};
    ++k_;
    return true;
  }
  bool straighten(std::vector<Eigen::Vector2f>&, cv::Mat&) const override { return false; }
  void label(recording::FrameRecord& frame) override {
    recording::set_corner_truth(recording::Truth::unknown, frame);
  }
  Diagnostics diagnostics() const override { return {}; }

  inline static const Intrinsics kCamera{
      .focal_px = 300, .centre_px = {159.5, 119.5}, .width_px = 320, .height_px = 240};

 private:
  static cv::Mat1b made_noise() {
    cv::Mat1b noise(kCamera.height_px, 2 * kCamera.width_px);
    cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(noise, noise, {}, 2);
    cv::normalize(noise, noise, 0, 255, cv::NORM_MINMAX);
    return noise;
  }

  cv::Mat1b noise_ = made_noise();
  int k_ = 0;
};

TEST(ForEachFrame, TheFilterSaysInASecondThreadAsInOne) {
  const scenario::Scenario scenario = scenario::load(LCS_SCENARIOS_DIR "/crossing.yaml", {});
  const auto recorded = [&](int threads) {
    Wall wall;
    LcsDetector filter(Wall::kCamera, filter_parameters(scenario));
    recording::Recording recording;
    std::set<std::thread::id> workers;
    const DetectorRun detector{filter, [&](const recording::FrameRecord& frame, const cv::Mat3b&) {
                                 workers.insert(std::this_thread::get_id());
                                 recording.frames.push_back(frame);
                               }};
    run(wall, CornerFinder(scenario), {&detector, 1}, threads);
    EXPECT_EQ(workers.contains(std::this_thread::get_id()), threads == 1);
    return recording;
  };
  const recording::Recording one = recorded(1), two = recorded(2);
  ASSERT_EQ(one.frames.size(), 8u);
  ASSERT_EQ(two.frames.size(), 8u);
  EXPECT_GT(one.frames[7].layers.normal_edges.size(), 50u);
  for (std::size_t k = 0; k < one.frames.size(); ++k) {
    EXPECT_EQ(one.frames[k].corners_px, two.frames[k].corners_px);
    EXPECT_EQ(one.frames[k].verdicts, two.frames[k].verdicts);
    EXPECT_EQ(one.frames[k].layers.normal_edges.size(), two.frames[k].layers.normal_edges.size());
    for (std::size_t i = 0; i < one.frames[k].layers.normal_edges.size(); ++i) {
      EXPECT_EQ(one.frames[k].layers.normal_edges[i].location,
                two.frames[k].layers.normal_edges[i].location);
    }
  }
}

TEST(FilterParameters, AreThePresetWithTheScenariosSettingsOnTop) {
  const auto load = [](std::vector<std::string> sets) {
    return filter_parameters(
        scenario::load(LCS_SCENARIOS_DIR "/crossing.yaml", {.sets = std::move(sets), .seed = {}}));
  };
  const auto mu_0 = [&](std::vector<std::string> sets) {
    return std::get<paper::PaperParameters>(load(std::move(sets))).edge.mu_0;
  };
  EXPECT_EQ(mu_0({"filter.preset=lab"}), paper::PaperParameters{}.edge.mu_0);
  EXPECT_EQ(mu_0({"filter.preset=lab", "filter.circle.mu_0=17"}), 17);
  EXPECT_THROW(load({"filter.preset=best"}), input::Error);
  EXPECT_THROW(load({"filter.circle.mu_0=17"}), input::Error);
  EXPECT_THROW(load({"filter.circle.gap=wide"}), input::Error);
  // Each value is in its range, but their order is wrong.
  EXPECT_THROW(load({"filter.circle.Tr_c=9", "filter.circle.Tr_m=5"}), input::Error);
}

TEST(Timed, ADetectorsTimeIsThatOfItsThreadAndLeavesOutWhatItWaits) {
  double cpu_ms = -1, wall_ms = -1;
  timed<std::chrono::steady_clock>(wall_ms, [&] {
    timed(cpu_ms, [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
  });
  EXPECT_GE(wall_ms, 20);
  EXPECT_GE(cpu_ms, 0);
  EXPECT_LT(cpu_ms, wall_ms - 10) << "sleeping takes no time of a processor";
}

/// Corners of events are near FAST's, which see the same outlines, and their truth is that of the
/// surfaces at their places.
TEST(CornersOfEvents, AreOnTheOutlinesThatThePicturesShow) {
  const std::vector<std::string> sets{"frames=4", "events={}", "corners.from=events"};
  const scenario::Scenario scenario =
      scenario::load(LCS_SCENARIOS_DIR "/crossing.yaml", {.sets = sets, .seed = {}});
  const auto run_once = [&] {
    sim::Simulation simulation(scenario);
    Alarmist detector;
    detector.want_signatures();
    recording::Recording recording{run_info(scenario, simulation), {}};
    run_into(recording, scenario, simulation, detector,
             [&](const recording::FrameRecord& frame, const cv::Mat3b& image) {
               if (frame.index == 0) {
                 EXPECT_TRUE(frame.corners_px.empty());
                 return;
               }
               cv::Mat1b grey, edges;
               cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
               cv::Canny(grey, edges, 30, 60);
               cv::dilate(edges, edges, cv::getStructuringElement(cv::MORPH_RECT, {7, 7}));
               int on_edges = 0, moving = 0;
               for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
                 const cv::Point px(cvRound(frame.corners_px[i].x()),
                                    cvRound(frame.corners_px[i].y()));
                 on_edges += edges(px) != 0;
                 moving += frame.corner_truth[i].label == sim::Label::rebel;
               }
               const auto all = static_cast<double>(frame.corners_px.size());
               EXPECT_GT(all, 20);
               EXPECT_GT(on_edges, 0.9 * all);
               EXPECT_GT(moving, 0);
               EXPECT_LT(moving, all);
               EXPECT_EQ(frame.signatures.size(), frame.corners_px.size());
             });
    return recording;
  };
  const recording::Recording first = run_once(), second = run_once();
  for (std::size_t k = 0; k < first.frames.size(); ++k) {
    EXPECT_EQ(first.frames[k].corners_px, second.frames[k].corners_px);
    EXPECT_EQ(first.frames[k].signatures, second.frames[k].signatures);
  }
}

}  // namespace
}  // namespace lcs::bench
