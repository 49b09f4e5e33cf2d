// `lcs run --view`: the effect of keys, and its behaviour with and without a display.
#include "tools/lcs/view.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>
#include <vector>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::tools {
namespace {

using test::Command;
using test::CommandResult;

constexpr int kNone = -1;

/// Plays frames while it gets one key after the other. \return the number of frames, and whether
/// the player continues.
std::pair<int, bool> frames_under(const std::vector<int>& keys) {
  std::size_t next = 0;
  int frames = 0;
  bool wants_more = true;
  Player player(
      [&](int) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return keys[next++];
      },
      1000);
  while (wants_more && next < keys.size()) {
    ++frames;
    wants_more = player.after_frame();
  }
  return {frames, wants_more};
}

TEST(Player, PausesStepsAndCloses) {
  // a frame takes 1 ms, and each key query 2 ms
  EXPECT_EQ(frames_under({kNone, kNone, kNone}), std::pair(3, true));
  // paused by the first key until it is pressed again
  EXPECT_EQ(frames_under({' ', kNone, kNone, ' ', kNone}), std::pair(2, true));
  // each dot advances one frame, and then playback pauses
  EXPECT_EQ(frames_under({'.', kNone, '.', kNone, kNone, ' '}), std::pair(3, true));
  EXPECT_EQ(frames_under({kNone, 'q', kNone}), std::pair(2, false));
  EXPECT_EQ(frames_under({' ', 27, kNone}), std::pair(1, false));
  EXPECT_EQ(frames_under({Player::kClosed, kNone}), std::pair(1, false));
}

class ViewCommand : public testing::Test {
 protected:
  ViewCommand() {
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) unsetenv(name);
  }
  std::vector<std::string> command() const {
    return {"run",   LCS_SCENARIOS_DIR "/crossing.yaml", "--view", "--frames", "4", "--no-video",
            "--set", "camera.size=[160, 120]",           "--out",  "out"};
  }
  const test::TemporaryFolder folder_;
};

TEST_F(ViewCommand, WithoutADisplayOneLineSaysSo) {
  const CommandResult unnamed = test::run_lcs(command(), {.folder = folder_.path()});
  EXPECT_EQ(unnamed.exit_code, 2);
  EXPECT_EQ(unnamed.err,
            "lcs: --view: there is no display (DISPLAY and WAYLAND_DISPLAY are not set); leave it "
            "out: video.mp4 shows the same\n");
  setenv("DISPLAY", ":4711", 1);
  const CommandResult gone = test::run_lcs(command(), {.folder = folder_.path()});
  EXPECT_EQ(gone.exit_code, 2) << gone.err;
  EXPECT_NE(gone.err.find("no window can be opened on the display"), std::string::npos) << gone.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(ViewCommand, TheLastFrameStaysWhenAllIsWritten) {
  setenv("QT_QPA_PLATFORM", "offscreen", 1);  // Qt's own invisible display
  Command running(command(), {.folder = folder_.path()});
  const std::filesystem::path metrics = folder_.path() / "out" / "metrics.json";
  for (int i = 0; i < 600 && !std::filesystem::exists(metrics); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(running.is_running());
  running.send(SIGTERM);
  const CommandResult result = running.wait();
  EXPECT_LE(result.exit_code, 1) << result.err;  // 1: a criterion is for another camera
  EXPECT_NE(result.out.find("rebels"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace lcs::tools
