// Sequences with events: RPG's text and DSEC's HDF5 have the events of the simulation.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/process/python.h"

namespace lcs::sequence {
namespace {

namespace fs = std::filesystem;
using bench::CommandResult;
using bench::run_lcs;

constexpr const char* kWorld = R"(scene: lab
frames: 4
ego: {start: [-3 m, 0 m], speed: 1.5 m/s}
camera: {size: [320, 240], distortion: [-0.1, 0.01, 0.001, 0.002, 0], time_offset: 2 ms}
events: {}
)";

class Events : public testing::Test {
 protected:
  Events() { bench::write(file(), kWorld); }
  fs::path file() const { return home_.path() / "drive.yaml"; }
  fs::path folder() const { return home_.path() / "out"; }
  CommandResult generate(const std::string& formats) const {
    return run_lcs({"generate", file(), "--formats", formats, "--out", folder(), "--quiet"},
                   {home_.path()});
  }
  std::vector<sim::Event> simulated() const {
    sim::Simulation simulation(scenario::load(file(), {}));
    std::vector<sim::Event> all;
    while (const auto o = simulation.next())
      all.insert(all.end(), o->events.begin(), o->events.end());
    return all;
  }
  bench::TemporaryFolder home_;
};

TEST_F(Events, AreReadBackFromRpgsText) {
  const CommandResult made = generate("events");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const fs::path rpg = folder() / "rpg";
  std::ifstream events(rpg / "events.txt");
  std::int64_t s = 0, ns = 0;
  char point = 0;
  int x = 0, y = 0, p = 0;
  std::vector<sim::Event> read;
  // the stamps are by the camera's clock, 2 ms before the IMU's
  while (events >> s >> point >> ns >> x >> y >> p) {
    read.push_back({(s - 1'000'000'000) * 1'000'000'000 + ns + 2'000'000,
                    static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), p == 1});
  }
  EXPECT_GT(read.size(), 1000U);
  EXPECT_EQ(read, simulated());

  std::ifstream images(rpg / "images.txt");
  std::string stamp, name;
  int pictures = 0;
  for (; images >> stamp >> name; ++pictures) {
    EXPECT_EQ(cv::imread((rpg / name).string()).size(), cv::Size(320, 240)) << name;
  }
  EXPECT_EQ(pictures, 4);
  std::istringstream calibration(bench::read(rpg / "calib.txt"));
  std::vector<double> numbers;
  for (double number = 0; calibration >> number;) numbers.push_back(number);
  ASSERT_EQ(numbers.size(), 9U);
  EXPECT_NEAR(numbers[0], 120 / std::tan(std::acos(-1) / 6), 1e-9);  // 60 deg over 240 rows
  EXPECT_EQ(std::vector<double>(numbers.begin() + 4, numbers.end()),
            (std::vector<double>{-0.1, 0.01, 0.001, 0.002, 0}));
}

/// By h5py, which also gives the first event of each millisecond.
TEST_F(Events, AreReadBackFromDsecsHdf5) {
  const CommandResult made = generate("dsec,events");
  if (made.err.find("needs h5py") != std::string::npos) GTEST_SKIP() << made.err;
  ASSERT_EQ(made.exit_code, 0) << made.err;
  bench::write(home_.path() / "read.py", R"(
import sys
import h5py, numpy as np
with h5py.File(sys.argv[1] + "/dsec/events.h5") as file:
    t, x, y, p = (file["events/" + name][:] for name in "txyp")
    offset, firsts = int(file["t_offset"][()]), file["ms_to_idx"][:].astype(int)
rows = [line.split() for line in open(sys.argv[1] + "/rpg/events.txt")]
assert len(rows) == len(t) > 1000
text_us = np.array([int(row[0].replace(".", "")) // 1000 for row in rows])
assert (t.astype(np.int64) + offset == text_us).all()
for column, place in ((x, 1), (y, 2), (p, 3)):
    assert (column == np.array([int(row[place]) for row in rows])).all()
assert len(firsts) == t[-1] // 1000 + 1
for ms, first in enumerate(firsts):
    assert t[first] >= ms * 1000 and (first == 0 or t[first - 1] < ms * 1000)
)");
  const std::vector<std::string> arguments{folder().string()};
  const process::PythonEnd end = process::run_python(home_.path() / "read.py", arguments);
  EXPECT_TRUE(end.is_fine) << end.err;
}

TEST_F(Events, OfACameraWithoutEventPixelsAreRefused) {
  const CommandResult result = run_lcs(
      {"generate", file(), "--formats", "events", "--out", folder(), "--quiet", "--set", "events="},
      {home_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("the camera has no event pixels; add 'events: {}', or leave events out "
                            "of --formats"),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(folder()));
}

}  // namespace
}  // namespace lcs::sequence
