// A child process for operations that may crash: its report to the parent, and its isolation.
#include "sim/base/trial.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>

namespace lcs::sim {
namespace {

TEST(Trial, SaysHowItEnded) {
  EXPECT_TRUE(try_in_child([] {}).fine);
  const Trial refused = try_in_child([] { throw std::runtime_error("not this"); });
  EXPECT_FALSE(refused.fine);
  EXPECT_EQ(refused.refused, "not this");
  EXPECT_EQ(refused.crash, "");
  EXPECT_EQ(try_in_child([] { ::raise(SIGSEGV); }).crash, "signal SEGV");
  EXPECT_EQ(try_in_child([] { std::abort(); }).crash, "signal ABRT");
  EXPECT_EQ(try_in_child([] { ::_exit(7); }).crash, "exit code 7");
  EXPECT_EQ(try_in_child([] { throw std::bad_alloc(); }).crash, "memory");
  EXPECT_EQ(try_in_child([] { throw std::length_error("as of a vector"); }).crash, "memory");
  EXPECT_EQ(try_in_child([] { ::raise(SIGKILL); }).crash, "memory") << "as the kernel does";
}

TEST(Trial, EndsWhatDoesNotEnd) {
  const auto for_ever = [] {
    while (::getpid() > 0) {
    }
  };
  TrialBounds bounds;
  bounds.processor_s = 1;
  EXPECT_EQ(try_in_child(for_ever, bounds).crash, "1 s of processor time");
  bounds.wall_s = 1;
  EXPECT_EQ(try_in_child([] { ::sleep(60); }, bounds).crash, "1 s");
}

TEST(Trial, HasMemoryForSoMuch) {
  const auto take = [](std::size_t bytes) {
    return [bytes] {
      void* memory = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (memory == MAP_FAILED) throw std::bad_alloc();
    };
  };
  constexpr std::size_t kMega = 1 << 20;
  TrialBounds bounds;
  bounds.more_memory = 100 * kMega;
  EXPECT_TRUE(try_in_child(take(50 * kMega), bounds).fine);
  EXPECT_EQ(try_in_child(take(200 * kMega), bounds).crash, "memory");
}

TEST(Trial, LeavesNothingBehind) {
  // buffered output is written once, by the parent; the child's output is discarded
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::printf("once");
  EXPECT_TRUE(try_in_child([] {
                std::printf("never");
                std::fflush(stdout);
                std::fprintf(stderr, "never");
              }).fine);
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "once");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "no child is left, dead or alive";
}

TEST(Trial, IsNotEndedByTheSignalsThatAreForItsParent) {
  for (const int sent : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_TRUE(try_in_child([sent] { ::raise(sent); }).fine) << sent;
  }
}

}  // namespace
}  // namespace lcs::sim
