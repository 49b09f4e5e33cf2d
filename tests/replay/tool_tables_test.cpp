// Tables of other tools: read by their headers, or refused with the line to write; clocks that fall
// back, ticks, and seconds that lack zeros.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

using Row = std::function<std::string(int)>;

class ToolTable : public testing::Test {
 protected:
  void write(const std::string& header, const Row& row, int rows = 40) {
    std::string text = header;
    for (int i = 0; i < rows; ++i) text += row(i) + "\n";
    test::write(path_, text);
  }
  PosesFile poses(const std::string& header, const Row& row) {
    write(header, row);
    return read_poses(path_, "", tally_);
  }
  std::vector<sim::ImuSample> imu(const std::string& header, const Row& row, int rows = 400) {
    write(header, row, rows);
    return read_imu_csv(path_, {"", kImuRate, kNanosecond_ns}, tally_);
  }
  /// Of pictures img/00000.jpg, ...
  std::vector<std::int64_t> times(const std::string& header, const Row& row, int rows = 20,
                                  int pictures = 20, int first = 0) {
    write(header, row, rows);
    Recorded recorded;
    for (int i = 0; i < pictures; ++i) {
      recorded.frames.push_back({0, fmt::format("img/{:05}.jpg", first + i), std::size_t(i)});
    }
    number_frames(recorded, false);
    time_by_table(path_, "", recorded);
    std::vector<std::int64_t> t_ms;
    for (const RecordedFrame& frame : recorded.frames) t_ms.push_back(frame.t_ns / 1'000'000);
    return t_ms;
  }
  void expect_refused(const std::function<void()>& read, const std::vector<const char*>& said) {
    const std::string what = test::refusal_of<input::Error>(read);
    EXPECT_NE(what.find(path_.string()), what.npos) << what;
    for (const char* part : said) EXPECT_NE(what.find(part), what.npos) << part << "\n" << what;
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "table.csv";
  Tally tally_;
};

TEST_F(ToolTable, OfPicturesMayBeginWithTheirNames) {
  std::vector<std::int64_t> expected;
  for (int i = 0; i < 20; ++i) expected.push_back(12'000 + 100 * i);
  for (const char* row :
       {"{:05}.jpg {}", "img/{:05}.jpg,{}", "img/{:05}.jpg;{}", "{:05}.JPG\t{}"}) {
    EXPECT_EQ(times("", [&](int i) { return fmt::format(fmt::runtime(row), i, 12 + 0.1 * i); }),
              expected)
        << row;
  }
  for (const char* row : {"frame_{}.png {}", "{}.png {}"}) {
    write(
        "", [&](int i) { return fmt::format(fmt::runtime(row), i, 12 + 0.1 * i); }, 20);
    Recorded recorded;
    take_list(
        read_table(path_), kSecond_ns,
        [](const TextTable::Row& of) { return fs::path(of.fields[1]); }, recorded);
    ASSERT_EQ(recorded.frames.size(), 20u) << row;
    EXPECT_EQ(recorded.frames[3].t_ns, 12'300'000'000);
    EXPECT_TRUE(recorded.frames[3].picture.string().ends_with("3.png"));
  }
  expect_refused([&] { poses("", [](int i) { return fmt::format("a{}.png 1 2 3 0 0 0 1", i); }); },
                 {"its first row begins with 'a0.png'"});
}

TEST_F(ToolTable, OfPosesIsReadByTheNamesOfItsColumnsInAnyCase) {
  for (const char* header :
       {"Timestamp\tX\tY\tZ\tQW\tQX\tQY\tQZ\n",
        "#t\tpos_x\tpos_y\tpos_z\trot_w\trot_x\trot_y\trot_z\n",
        "time[s]\tPosX [m]\tPosY [m]\tPosZ [m]\tQuatW\tQuatX\tQuatY\tQuatZ\n",
        "%time\tfield.pose.position.x\tfield.pose.position.y\tfield.pose.position.z\t"
        "field.pose.orientation.w\tfield.pose.orientation.x\tfield.pose.orientation.y\t"
        "field.pose.orientation.z\n"}) {
    const PosesFile read =
        poses(header, [](int i) { return fmt::format("{}.5\t1\t2\t3\t0\t1\t0\t0", i); });
    ASSERT_TRUE(read.lines[1]) << header;
    EXPECT_EQ(read.lines[1]->t_ns, 1'500'000'000) << header;
    EXPECT_EQ(read.lines[1]->T_WC.p, Eigen::Vector3d(1, 2, 3)) << header;
    EXPECT_NEAR(read.lines[1]->T_WC.R(0, 0), 1, 1e-9) << "half a turn about x: " << header;
  }
}

TEST_F(ToolTable, OfPosesWithAHeaderThatIsNotUnderstoodIsRefusedWithItsColumns) {
  const Row row = [](int i) { return fmt::format("{},1,2,3,0,1,0,0", 0.1 * i); };
  for (const char* header :
       {"time,x,y,z,q0,q1,q2,q3\n", "time,x,y,z,roll,pitch,yaw,mode\n", "a,b,c,d,e,f,g,h\n",
        "# time,x,y,z,rx,ry,rz,rw\n", "time,x [mm],y [mm],z [mm],qw,qx,qy,qz\n",
        "time,x,y,z,x,qx,qy,qz,qw\n"}) {
    std::string names = header;
    expect_refused(
        [&] { poses(header, row); },
        {"the header does not name one position in m and one quaternion: its columns are ",
         "give the columns time, x, y, z, qx, qy, qz, qw"});
  }
  expect_refused([&] { poses("moment,x,y,z,qw,qx,qy,qz\n", row); },
                 {"the header names no time: its columns are moment, x, y"});
  const Row tum = [](int i) { return fmt::format("{} 1 2 3 1 0 0 0", 0.1 * i); };
  EXPECT_TRUE(poses("# the path of the camera on its cart\n", tum).timed) << "a comment of 8 words";
}

TEST_F(ToolTable, OfToolsWhosePosesAreNotOfACameraIsRefusedWithTheLineToWrite) {
  const Row vins = [](int i) {
    return fmt::format("{},1,2,3,1,0,0,0,0,0,0,", 1'403'636'579'000'000'000 + i * 100'000'000LL);
  };
  expect_refused([&] { poses("", vins); },
                 {"VINS-Mono or VINS-Fusion", "write time [ns],p_RS_R_x"});
  const PosesFile written =
      poses("time [ns],p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,vx,vy,vz,\n", vins);
  EXPECT_TRUE(written.of_body && written.lines[0]);
  const Row aria = [](int i) {
    return fmt::format("f1e2,{},{},1,2,3,0,0,0,1,1", 1000 + i * 100'000, i);
  };
  expect_refused(
      [&] {
        poses(
            "graph_uid,tracking_timestamp_us,utc_timestamp_ns,tx_world_device,ty_world_device,tz_"
            "world_device,"
            "qx_world_device,qy_world_device,qz_world_device,qw_world_device,quality_score\n",
            aria);
      },
      {"Project Aria", "p_RS_R_x"});
  const PosesFile device = poses(
      "graph_uid,time [us],utc,p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_x,q_RS_y,q_RS_z,q_RS_w,a\n", aria);
  ASSERT_EQ(device.lines.size(), 40u) << "rows that begin with a word";
  EXPECT_EQ(device.lines[0]->t_ns, 1'000'000);
  const Row airsim = [](int i) {
    return fmt::format("Car\t{}\t1\t2\t3\t1\t0\t0\t0\timg_{}.png", 1000 + 100 * i, i);
  };
  expect_refused(
      [&] {
        poses("VehicleName\tTimeStamp\tPOS_X\tPOS_Y\tPOS_Z\tQ_W\tQ_X\tQ_Y\tQ_Z\tImageFile\n",
              airsim);
      },
      {"AirSim", "by a calibration"});
  EXPECT_EQ(
      poses("name\ttime [ms]\tp_RS_R_x\tp_RS_R_y\tp_RS_R_z\tq_RS_w\tq_RS_x\tq_RS_y\tq_RS_z\tfile\n",
            airsim)
          .lines[1]
          ->t_ns,
      1'100'000'000);
  expect_refused(
      [&] {
        poses("timestamp_ns,qw,qx,qy,qz,tx_m,ty_m,tz_m\n",
              [](int i) { return fmt::format("{},1,0,0,0,1,2,3", i); });
      },
      {"Argoverse 2"});
}

TEST_F(ToolTable, MayHaveSecondsBesideTheirFractions) {
  for (const char* header :
       {"#sec,nsec,x,y,z,qx,qy,qz,qw\n", "stamp.secs,stamp.nsecs,x,y,z,qx,qy,qz,qw\n"}) {
    const PosesFile read = poses(header, [](int i) {
      return fmt::format("{},{},1,2,3,0,0,0,1", 100 + i / 10, i % 10 * 100'000'000);
    });
    EXPECT_EQ(read.lines[12]->t_ns, 101'200'000'000) << header;
  }
  const PosesFile micro = poses("sec,usec,x,y,z,qx,qy,qz,qw\n", [](int i) {
    return fmt::format("{},{},1,2,3,0,0,0,1", 100 + i / 10, i % 10 * 100'000);
  });
  EXPECT_EQ(micro.lines[12]->t_ns, 101'200'000'000);
  const PosesFile twice = poses("time_s,x,y,z,qx,qy,qz,qw,time_ns\n", [](int i) {
    return fmt::format("{:.1f},1,2,3,0,0,0,1,{}", 100 + 0.1 * i,
                       100'000'000'000 + i * 100'000'000LL);
  });
  EXPECT_EQ(twice.lines[1]->t_ns, 100'100'000'000) << "two columns of whole times";
}

TEST_F(ToolTable, OfAnImuWithOtherColumnsNeedsAHeader) {
  const Row kaist = [](int i) {
    return fmt::format("{},0,0,0,1,0,0,0,0.01,0.02,0.03,0.1,0.2,9.8,1,2,3",
                       1'544'676'000'000'000'000 + i * 10'000'000LL);
  };
  expect_refused([&] { imu("", kaist); }, {"it has 17 columns and no header", "KAIST"});
  EXPECT_EQ(imu("time "
                "[ns],qx,qy,qz,qw,ex,ey,ez,w_RS_S_x,w_RS_S_y,w_RS_S_z,a_RS_S_x,a_RS_S_y,a_RS_S_z,"
                "mx,my,mz\n",
                kaist)[0]
                .accel_mps2.z(),
            9.8);
  const Row six = [](int i) { return fmt::format("{},0.01,0.02,0.03,0.1,0.2,9.8,", 5 * i); };
  EXPECT_EQ(imu("", six).size(), 400u) << "a last comma";
  expect_refused([&] { imu("time,gx_dps,gy_dps,gz_dps,ax,ay,az\n", six); },
                 {"its columns are time, gx_dps"});
  expect_refused([&] { imu("count,wx,wy,wz,ax,ay,az\n", six); },
                 {"the header names no time: its columns are count"});
}

TEST_F(ToolTable, OfXsensHasTicksAndThatOfGyroflowIsRefused) {
  const auto read = imu(
      "// Sample rate: 200.0Hz\nPacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z\n",
      [](int i) { return fmt::format("{},{},0.1,0.2,9.8,0,0,0", i, 50 * i); });
  EXPECT_EQ(read[1].t_ns, 5'000'000);
  expect_refused(
      [&] {
        imu("GYROFLOW IMU "
            "LOG\nversion,1.3\norientation,xyz\ntscale,0.005\ngscale,1.0\nascale,1.0\nt,gx,gy,gz,"
            "ax,ay,az\n",
            [](int i) { return fmt::format("{},0,0,0,0,0,1", i); });
      },
      {"Gyroflow", "time [s],w_RS_S_x"});
}

TEST_F(ToolTable, WithTicksOf100NanosecondsIsRefused) {
  for (const std::int64_t zero : {132'702'448'095'356'149, 637'450'560'000'000'000}) {
    expect_refused(
        [&] { times("", [=](int i) { return fmt::format("{}", zero + 1'000'000LL * i); }); },
        {"ticks of 100 ns", "ns since 1970"});
  }
}

TEST_F(ToolTable, WhoseSecondsLackZerosIsRefused) {
  constexpr std::int64_t kStart_ns = 1'532'402'927'950'000'000, kPeriod_ns = 33'333'333;
  const auto lacks = [](std::int64_t t_ns, std::int64_t per_second) {
    return fmt::format("{}.{}", t_ns / 1'000'000'000,
                       t_ns % 1'000'000'000 / (1'000'000'000 / per_second));
  };
  for (const std::int64_t per_second : {1'000'000'000LL, 1'000'000LL, 1000LL}) {
    expect_refused(
        [&] { times("", [&](int i) { return lacks(kStart_ns + i * kPeriod_ns, per_second); }); },
        {"lack leading zeros"});
    std::vector<std::filesystem::path> names;
    for (int i = 0; i < 20; ++i)
      names.emplace_back("p/" + lacks(kStart_ns + i * kPeriod_ns, per_second) + ".png");
    EXPECT_NE(
        test::refusal_of<input::Error>([&] { in_order(names, ""); }).find("lack leading zeros"),
        std::string::npos);
  }
  // Python writes no zeros behind the last digit.
  const auto t_ms = times("", [](int i) { return fmt::format("{}", 1'305'031'102.05 + 0.05 * i); });
  EXPECT_EQ((t_ms[7] - t_ms[0] + 1) / 10, 35);
  EXPECT_EQ(
      in_order({"p/1305031102.15.png", "p/1305031102.2.png", "p/1305031102.25.png"}, "").t_ns[2],
      1'305'031'102'250'000'000);
}

TEST_F(ToolTable, WhoseClockFallsBackIsRefused) {
  const auto row = [](std::int64_t t_ms) {
    return fmt::format("{},0.01,0.02,0.03,0.1,0.2,9.8", t_ms);
  };
  const std::string header = "time [ms],wx,wy,wz,ax,ay,az\n";
  for (const int shift : {0, 2}) {
    expect_refused(
        [&] { imu(header, [&](int i) { return row(i < 200 ? 5 * i : 5 * (i - 200) + shift); }); },
        {"its clock falls back from 995000000 to", "give the rows before or after that alone"});
  }
  expect_refused([&] { imu(header, [&](int i) { return row(i < 200 ? 5 * i : 5 * i - 52); }); },
                 {"its clock falls back"});
  expect_refused([&] { imu(header, [&](int i) { return row(5 * (i % 20)); }); },
                 {"its clock falls back from 95000000 to 0 ns"});
  EXPECT_EQ(imu(header, [&](int i) { return row(5 * ((i + 200) % 400)); }).size(), 400u)
      << "halves in the wrong order";
  EXPECT_EQ(imu(header, [&](int i) { return row(5 * (i ^ 3)); }).size(), 400u)
      << "rows that are late";
}

TEST_F(ToolTable, WhoseTimesWereRoundedIsRefused) {
  expect_refused(
      [&] {
        imu("time [ns],wx,wy,wz,ax,ay,az\n", [](int i) {
          return fmt::format("{:.5E},0.01,0.02,0.03,0.1,0.2,9.8", 1.317643e18 + 5e6 * i);
        });
      },
      {"only 1 of its 400 times differ"});
}

TEST_F(ToolTable, OfColmapHasNoTimes) {
  const auto id = [](int i) { return (7 * i) % 20 + 1; };
  const Row colmap = [&](int i) {
    return fmt::format("{} 0.9 0 0.{} 0 1 2 {} 1 {:05}.jpg", id(i), i % 3, i, i);
  };
  expect_refused(
      [&] {
        times(
            "# Image list with two lines of data per image:\n#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, "
            "TZ, CAMERA_ID, NAME\n",
            colmap);
      },
      {"COLMAP"});
  expect_refused([&] { times("", [&](int i) { return fmt::format("{} {:05}.jpg", id(i), i); }); },
                 {"no column holds times that increase"});
  expect_refused([&] { times("", [&](int i) { return fmt::format("{}", id(i)); }); },
                 {"no column holds times that increase"});
  expect_refused(
      [&] { times("number,moment\n", [&](int i) { return fmt::format("{},{}", i, 0.1 * i); }); },
      {"its columns are number, moment"});
}

TEST_F(ToolTable, OfTimesThatCountsFromZeroBelongsToPicturesThatCountFromOne) {
  test::write(path_, "0 5.1\n1 5.2\n2 5.3\n");
  Recorded recorded;
  for (std::size_t i = 0; i < 3; ++i)
    recorded.frames.push_back({0, fmt::format("img/{}.jpg", i + 1), i});
  time_by_table(path_, "", recorded);
  ASSERT_EQ(recorded.frames.size(), 3u);
  EXPECT_EQ(recorded.frames[0].t_ns, 5'100'000'000);
}

TEST_F(ToolTable, OfTimesMayStateNumbersAndFoldersOfPictures) {
  const auto stated = times(
      "frame,time_ms\n", [](int i) { return fmt::format("{},{}", i + 1, 100 * (i + 1)); }, 30, 20,
      5);
  const auto pairs = times("sec,nsec,name\n", [](int i) {
    return fmt::format("{},{},{:05}.jpg", 7 + i / 10, i % 10 * 100'000'000, i);
  });
  EXPECT_EQ(pairs[12], 8200);
  const auto exposed = times("name,exposure_time,timestamp [ms]\n",
                             [](int i) { return fmt::format("{:05},30,{}", i, 100 * i); });
  EXPECT_EQ(exposed[12], 1200);
  EXPECT_EQ(stated.front(), 500) << "picture 5, in the fifth row";
  const auto both = times(
      "# id time_ms name\n",
      [](int i) { return fmt::format("{} {} img/{:05}.jpg", i + 1, 100 * i, i); }, 30, 20, 5);
  EXPECT_EQ(both.front(), 500) << "names count more than numbers";
  const auto folders = [](const char* first, const char* second) {
    return [=](int i) {
      return fmt::format("{} {}/{:05}.jpg", 100 * (i / 2) + 50 * (i % 2), i % 2 ? second : first,
                         i / 2);
    };
  };
  EXPECT_EQ(times("# time_ms name\n", folders("back", "img"), 40)[3], 350);
  expect_refused([&] { times("# time_ms name\n", folders("right", "left"), 40); },
                 {"right/00000.jpg and left/00000.jpg may both be the picture 00000.jpg"});
}

}  // namespace
}  // namespace lcs::replay
