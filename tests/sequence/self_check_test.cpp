// The truth of real frames is consistent; each typical fault of generators is
// detected.
#include "tools/sequence/self_check.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <optional>

#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tools/sequence/true_flow.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

/// Two frames of a scenario in which two objects cross before a rover that drives on.
class SelfCheck : public testing::Test {
 protected:
  SelfCheck() : scenario_(scenario::load(LCS_SCENARIOS_DIR "/crossing.yaml")) {
    sim::Simulation simulation(scenario_);
    for (int k = 0; k < 20; ++k) simulation.skip();
    now_ = *simulation.next();
    next_ = *simulation.next();
    calibration_ = simulation.calibration();
    objects_ = static_cast<int>(simulation.objects().size());
  }

  TrueFlow field() const {
    return true_flow(calibration_.camera, now_.truth, now_.geom, {next_.truth.depth_m, next_.geom});
  }
  Agreement check(const cv::Mat2f& motion, const cv::Mat1b& seen) const {
    return check_flow(calibration_.camera, now_, next_, motion, seen);
  }
  cv::Mat1w mask() const { return object_mask(now_.truth); }
  Agreement check_readings() const {
    return check_imu(scenario_.imu, calibration_.gravity_mps2, now_);
  }

  scenario::Scenario scenario_;
  sim::Observation now_, next_;
  sim::Calibration calibration_;
  int objects_ = 0;
};

TEST_F(SelfCheck, TheFlowOfRealFramesLeadsThereAndBackOnMostOfThePicture) {
  const TrueFlow motion = field();
  const Agreement agreement = check(motion.full_px, motion.seen);
  EXPECT_GT(agreement.compared, 8000) << "of 19200 places";
  EXPECT_LT(agreement.worst, 0.02) << "the quantum of the format is 0.0156 px";
}

TEST_F(SelfCheck, FlowThatLeavesMovingObjectsOutIsFound) {
  const TrueFlow motion = field();
  EXPECT_THROW(check(motion.ego_px, motion.seen), TruthError);
}

TEST_F(SelfCheck, FlowWithAxesOrSignsInterchangedIsFound) {
  TrueFlow motion = field();
  cv::Mat2f turned = motion.full_px.clone();
  for (cv::Vec2f& u : turned) std::swap(u[0], u[1]);
  EXPECT_THROW(check(turned, motion.seen), TruthError);
  turned = -motion.full_px;
  EXPECT_THROW(check(turned, motion.seen), TruthError);
}

TEST_F(SelfCheck, DepthThatIsOffByHalfAPerCentIsFound) {
  now_.truth.depth_m *= 1.005;
  const TrueFlow motion = field();
  EXPECT_THROW(check(motion.full_px, motion.seen), TruthError);
}

TEST_F(SelfCheck, DepthAlongTheRayInsteadOfTheAxisIsFound) {
  for (sim::Observation* frame : {&now_, &next_}) {
    for (int y = 0; y < frame->truth.depth_m.rows; ++y) {
      for (int x = 0; x < frame->truth.depth_m.cols; ++x) {
        frame->truth.depth_m(y, x) *=
            static_cast<float>(calibration_.camera.back_project({x, y}, 1).norm());
      }
    }
  }
  const TrueFlow motion = field();
  EXPECT_THROW(check(motion.full_px, motion.seen), TruthError);
}

TEST_F(SelfCheck, APoseThatIsAMillimetreOrAMilliradianOffIsFound) {
  const sim::Pose right = next_.truth.now.T_WC;
  const TrueFlow motion = field();
  next_.truth.now.T_WC.p.y() += 1e-3;
  EXPECT_THROW(check(motion.full_px, motion.seen), TruthError);
  next_.truth.now.T_WC = right;
  next_.truth.now.T_WC.R =
      right.R * Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_THROW(check(motion.full_px, motion.seen), TruthError);
}

TEST_F(SelfCheck, BoxesOfRealFramesAreThoseOfTheirMasks) {
  EXPECT_FALSE(now_.objects.empty());
  EXPECT_NO_THROW(check_masks(now_.index, mask(), now_.objects, objects_));
}

TEST_F(SelfCheck, ABoxAPixelOffAnObjectWithoutABoxAndABoxWithoutAnObjectAreFound) {
  const std::vector<sim::ObjectTruth> right = now_.objects;
  std::vector<sim::ObjectTruth> wrong = right;
  ++wrong.front().right;
  EXPECT_THROW(check_masks(20, mask(), wrong, objects_), TruthError);
  wrong = right;
  wrong.pop_back();
  EXPECT_THROW(check_masks(20, mask(), wrong, objects_), TruthError);
  cv::Mat1w emptied = mask();
  emptied.setTo(0, emptied == right.front().object);
  EXPECT_THROW(check_masks(20, emptied, right, objects_), TruthError);
}

TEST_F(SelfCheck, ThePictureOfRealFramesMovesAsTheFlowSays) {
  const Agreement agreement = check_picture(now_, next_, field());
  EXPECT_GT(agreement.compared, 600) << "of 1200 blocks";
  EXPECT_LT(agreement.worst, 0.1);
}

TEST_F(SelfCheck, APictureThatDoesNotMoveWithTheFlowIsFound) {
  TrueFlow motion = field();
  motion.full_px = motion.ego_px;  // as if the moving objects stood still
  EXPECT_THROW(check_picture(now_, next_, motion), TruthError);
}

TEST_F(SelfCheck, TheOutlinesOfRealFramesAreWhereTheirMasksAre) {
  const Agreement agreement = check_outlines(now_, mask());
  EXPECT_GE(agreement.compared, 2) << "two objects cross";
  EXPECT_LT(agreement.worst, 1.5);
}

TEST_F(SelfCheck, AMaskThatIsShiftedByTwoPixelsIsFound) {
  for (const cv::Point by :
       {cv::Point(2, 0), cv::Point(-2, 0), cv::Point(0, 2), cv::Point(0, -2), cv::Point(2, 2)}) {
    cv::Mat1w shifted(mask().size(), std::uint16_t{0});
    const cv::Rect all({0, 0}, shifted.size());
    mask()((all - by) & all).copyTo(shifted((all + by) & all));
    EXPECT_THROW(check_outlines(now_, shifted), TruthError) << by;
  }
}

TEST_F(SelfCheck, TheReadingsOfTheImuLeadFromPoseToPoseWithinTheirNoise) {
  const Agreement agreement = check_readings();
  EXPECT_EQ(agreement.compared, 2) << "attitude and velocity";
  EXPECT_LT(agreement.worst, 1);
  EXPECT_GT(agreement.worst, 0) << "there is noise";
}

TEST_F(SelfCheck, AnImuWithAWrongAxisUnitGravityOrBiasIsFound) {
  const auto found_after = [&](auto&& spoil) {
    const sim::Observation right = now_;
    for (std::size_t i = 0; i < now_.imu.size(); ++i) spoil(now_.imu[i], now_.imu_truth[i]);
    EXPECT_THROW(check_readings(), TruthError);
    now_ = right;
  };
  found_after(
      [](sim::ImuSample& s, sim::ImuTruth&) { std::swap(s.accel_mps2.x(), s.accel_mps2.z()); });
  found_after([](sim::ImuSample& s, sim::ImuTruth&) { s.accel_mps2 /= 9.81; });
  found_after([](sim::ImuSample& s, sim::ImuTruth&) { s.accel_mps2.z() -= 9.81; });
  found_after([](sim::ImuSample&, sim::ImuTruth& t) { t.gyro_bias_radps.z() += 0.1; });
  found_after([](sim::ImuSample& s, sim::ImuTruth&) { s.gyro_radps.x() += 0.1; });
}

TEST_F(SelfCheck, AGapInTheImuIsNoFault) {
  now_.imu.erase(now_.imu.begin() + 5);
  EXPECT_EQ(check_readings().compared, 0);
}

TEST_F(SelfCheck, TimesOutOfStepAreFound) {
  EXPECT_NO_THROW(check_times(scenario_, now_));
  const sim::Observation right = now_;
  now_.t_ns += 1;
  EXPECT_THROW(check_times(scenario_, now_), TruthError);
  now_ = right;
  now_.imu_truth.back().t_ns += 5'000'000;  // a reading after the frame
  EXPECT_THROW(check_times(scenario_, now_), TruthError);
  now_ = right;
  now_.imu_truth[3].t_ns += 1;  // off the grid
  EXPECT_THROW(check_times(scenario_, now_), TruthError);
  now_ = right;
  std::swap(now_.imu_truth[3], now_.imu_truth[4]);
  EXPECT_THROW(check_times(scenario_, now_), TruthError);
}

}  // namespace
}  // namespace lcs::sequence
