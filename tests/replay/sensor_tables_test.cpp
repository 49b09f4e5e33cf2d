// Tables of an IMU and of times with the columns, separators and units of several tools, and
// readings that no IMU can have.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

using test::refusal_of;

using Row = std::function<std::string(int)>;

class SensorTable : public testing::Test {
 protected:
  std::vector<sim::ImuSample> read(const std::string& header, const Row& row,
                                   const std::string& unit = "") {
    std::string text = header + "\n";
    for (int i = 0; i < 400; ++i) text += row(i) + "\n";
    test::write(path_, text);
    return read_imu_csv(path_, {unit, kImuRate, kNanosecond_ns}, tally_);
  }
  std::string refusal(const std::string& header, const Row& row, const std::string& unit = "") {
    return refusal_of<input::Error>([&] { read(header, row, unit); });
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "imu.csv";
  Tally tally_;
};

void expect_still(const std::vector<sim::ImuSample>& samples, std::int64_t period_ns) {
  ASSERT_EQ(samples.size(), 400u);
  EXPECT_EQ(samples[7].t_ns - samples[0].t_ns, 7 * period_ns);
  EXPECT_LT((samples[7].gyro_radps - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-9);
  EXPECT_LT((samples[7].accel_mps2 - Eigen::Vector3d(0.1, 0.2, 9.8)).norm(), 1e-9);
}

constexpr std::int64_t kPeriod_ns = 5'000'000;

TEST_F(SensorTable, OfSeveralToolsIsReadByItsHeader) {
  expect_still(read("#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
                    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]",
                    [](int i) {
                      return fmt::format("{},0.01,0.02,0.03,0.1,0.2,9.8",
                                         1'403'636'579'000'000'000 + i * kPeriod_ns);
                    }),
               kPeriod_ns);
  // Kalibr's bagcreater, and UZH-FPV
  expect_still(
      read("timestamp,omega_x,omega_y,omega_z,alpha_x,alpha_y,alpha_z",
           [](int i) { return fmt::format("{},0.01,0.02,0.03,0.1,0.2,9.8", i * kPeriod_ns); }),
      kPeriod_ns);
  expect_still(read(
                   "# timestamp ang_vel_x ang_vel_y ang_vel_z lin_acc_x lin_acc_y lin_acc_z",
                   [](int i) {
                     return fmt::format("{:.9f} 0.01 0.02 0.03 0.1 0.2 9.8",
                                        1540113212.5 + 1e-9 * kPeriod_ns * i);
                   },
                   "s")
                           .size() == 400
                   ? read("t gyr_x gyr_y gyr_z acc_x acc_y acc_z",
                          [](int i) {
                            return fmt::format("{}.{:03} 0.01 0.02 0.03 0.1 0.2 9.8", i / 200,
                                               i % 200 * 5);
                          })
                   : std::vector<sim::ImuSample>{},
               kPeriod_ns);
  // rostopic echo -p
  expect_still(
      read("%time,field.header.seq,field.header.stamp,field.header.frame_id,"
           "field.orientation.x,field.orientation.y,field.orientation.z,field.orientation.w,"
           "field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z,"
           "field.angular_velocity_covariance0,field.linear_acceleration.x,"
           "field.linear_acceleration.y,field.linear_acceleration.z",
           [](int i) {
             return fmt::format("{},{},{},imu,0,0,0,1,0.01,0.02,0.03,0,0.1,0.2,9.8",
                                77 + i * kPeriod_ns + i % 2, i, 1000 + i * kPeriod_ns);
           }),
      kPeriod_ns);
  // a phone's logger, in other units, and accelerations first
  expect_still(read("timestamp_ms;accelerometerAccelerationX(G);accelerometerAccelerationY(G);"
                    "accelerometerAccelerationZ(G);gyroRotationX(deg/s);gyroRotationY(deg/s);"
                    "gyroRotationZ(deg/s);motionUserAccelerationX(G)",
                    [](int i) {
                      constexpr double kG = 9.80665, kDegree = std::numbers::pi / 180;
                      std::string row =
                          fmt::format("{};{};{};{};{};{};{};0", 5 * i, 0.1 / kG, 0.2 / kG, 9.8 / kG,
                                      0.01 / kDegree, 0.02 / kDegree, 0.03 / kDegree);
                      std::replace(row.begin(), row.end(), '.', ',');
                      return row;
                    }),
               kPeriod_ns);
}

Row at_period(double period, const char* rest) {
  return [=](int i) { return fmt::format("{},{}", period * i, rest); };
}

TEST_F(SensorTable, WithoutAUnitOfTimeHasTheOneThatGivesARate) {
  for (const auto& [period, unit] : {std::pair{0.005, "s"}, {5.0, "ms"}, {5000.0, "us"}}) {
    expect_still(read("", at_period(period, "0.01,0.02,0.03,0.1,0.2,9.8")), kPeriod_ns);
    EXPECT_NE(tally_.lines().front().find(fmt::format("in {}: 200 Hz", unit)), std::string::npos)
        << tally_.lines().front();
    tally_ = {};
  }
}

TEST_F(SensorTable, WithAUnitThatContradictsTheRateIsRefused) {
  const Row row = at_period(5, "0.01,0.02,0.03,0.1,0.2,9.8");
  const std::string header = "t [ns],w_x,w_y,w_z,a_x,a_y,a_z";
  EXPECT_NE(refusal(header, row)
                .find("its times are in ns by its header, which gives 2e+08 rows a "
                      "second, and a sensor of its kind has 12 to 11000 Hz; if they "
                      "are in ms, give time_unit: ms"),
            std::string::npos)
      << refusal(header, row);
  expect_still(read(header, row, "ms"), kPeriod_ns);
  expect_still(read("t [ms],w_x,w_y,w_z,a_x,a_y,a_z", row, "ns"), kPeriod_ns);
}

TEST_F(SensorTable, WithAnotherRateThanIsStatedIsToldSo) {
  test::write(path_, "t [ms]\n0\n100\n200\n300\n");
  const TextTable table = read_table(path_);
  EXPECT_EQ((TableTimes{"", {1, 100, 20, "sensor.yaml"}, {}}.unit_ns(table, 0, tally_)),
            kMillisecond_ns);
  EXPECT_NE(tally_.lines().at(0).find("has 10 rows a second, and sensor.yaml states 20 Hz"),
            std::string::npos);
}

TEST_F(SensorTable, WithReadingsOfNoImuIsRefused) {
  const std::string header = "t [ms],w_x,w_y,w_z,a_x,a_y,a_z";
  const auto why = [&](const char* rest) { return refusal(header, at_period(5, rest)); };
  EXPECT_NE(why("0.1,0.2,28,0.1,0.2,9.8").find("if they are in deg/s"), std::string::npos);
  EXPECT_NE(why("0.1,0.2,9.8,0.1,0.2,0.3").find("the two seem interchanged"), std::string::npos);
  EXPECT_NE(why("0,0,0,0,0,1").find("gravity in g"), std::string::npos);
  EXPECT_NE(why("0,0,0,0.1,0.1,0.1").find("gravity included, in m/s^2"), std::string::npos);
  EXPECT_NE(why("0,0,0,0,0,16384").find("gravity included, in m/s^2"), std::string::npos);
}

TEST_F(SensorTable, WithRatesInDegreesIsRefusedAlsoWhereTheyAreSmall) {
  // It rolls by 1 deg to either side; the accelerometer shows it.
  constexpr double kDegree = std::numbers::pi / 180, kRate = 5, kSwing_deg = 1;
  const auto swings = [](double unit) {
    return [unit](int i) {
      const double t = 0.005 * i, roll = kSwing_deg * kDegree * std::sin(kRate * t);
      const double rate_degps = kSwing_deg * kRate * std::cos(kRate * t);
      return fmt::format("{},{},0,0,0,{},{}", 5 * i, rate_degps * unit, 9.81 * std::sin(roll),
                         9.81 * std::cos(roll));
    };
  };
  const std::string header = "t [ms],w_x,w_y,w_z,a_x,a_y,a_z";
  EXPECT_EQ(read(header, swings(kDegree)).size(), 400u);
  EXPECT_NE(refusal(header, swings(1)).find("and contradict the accelerometer"), std::string::npos);
}

TEST_F(SensorTable, OfPosesHasTheColumnsOfItsFormat) {
  const auto poses = [&](const std::string& text) {
    test::write(path_, text);
    return read_poses(path_, "", tally_);
  };
  const PosesFile euroc = poses(
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z []\n1403636579000000000,1,2,3,0,1,0,0\n1403636579005000000,1,2,3,0,1,0,0\n");
  EXPECT_TRUE(euroc.of_body);
  EXPECT_EQ(euroc.lines[0]->t_ns, 1'403'636'579'000'000'000);
  EXPECT_EQ(euroc.lines[0]->T_WC.p.z(), 3);
  EXPECT_EQ(euroc.lines[0]->T_WC.R(0, 0), 1) << "half a turn about x";
  const PosesFile named = poses("time,x,y,z,qx,qy,qz,qw\n0.1,1,2,3,0,0,0,1\n0.2,1,2,3,0,0,0,1\n");
  EXPECT_FALSE(named.of_body);
  EXPECT_EQ(named.lines[1]->t_ns, 200'000'000);
  EXPECT_EQ(poses("1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n").lines[0]->T_WC.p.y(), 5);
  EXPECT_EQ(poses("7 1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n").lines[0]->number, 7u);
  const std::string state =
      "#timestamp,p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,v_RS_R_x,v_RS_R_y,"
      "v_RS_R_z\n";
  EXPECT_NO_THROW(
      poses(state + "1000000000,0,0,0,1,0,0,0,9,0,0\n1500000000,4.5,0,0,1,0,0,0,9,0,0\n"));
  EXPECT_NE(refusal_of<input::Error>([&] {
              poses(state + "1000000000,0,0,0,1,0,0,0,9,0,0\n1500000000,0,0,0,1,0,0,0,9,0,0\n");
            }).find("its positions move by 0 m in all, and its velocities by 4.5 m"),
            std::string::npos);
  EXPECT_NE(refusal_of<input::Error>([&] { poses("1,0,0,0,1,0,0,0\n"); }).find("give it a header"),
            std::string::npos);
}

TEST_F(SensorTable, OfTimesBelongsToPicturesByNameOrByRow) {
  const auto timed = [&](const std::string& text) {
    Recorded recorded;
    for (std::size_t i = 0; i < 3; ++i) {
      recorded.frames.push_back({0, fmt::format("images/{:05}.jpg", i), i});
    }
    test::write(path_, text);
    time_by_table(path_, "", recorded);
    std::vector<std::int64_t> t_ms;
    for (const RecordedFrame& frame : recorded.frames) t_ms.push_back(frame.t_ns / 1'000'000);
    return t_ms;
  };
  using Times = std::vector<std::int64_t>;
  EXPECT_EQ(timed("0.1\n0.2\n0.3\n"), (Times{100, 200, 300}));
  EXPECT_EQ(timed("00000 5.1 0.03\n00001 5.2 0.03\n00002 5.3 0.03\n"), (Times{5100, 5200, 5300}))
      << "TUM-mono";
  EXPECT_EQ(timed("# id timestamp image_name\n0 5.1 img/00001.jpg\n1 5.2 img/00002.jpg\n"),
            (Times{5100, 5200}))
      << "UZH-FPV; a picture without a row is left out";
  EXPECT_EQ(timed("frame,time_us\n0,100000\n1,200000\n2,300000\n"), (Times{100, 200, 300}));
  const std::string why = refusal_of<input::Error>([&] { timed("0.1\n0.2\n"); });
  EXPECT_NE(why.find("has 2 times for 3 pictures"), std::string::npos) << why;
}

}  // namespace
}  // namespace lcs::replay
