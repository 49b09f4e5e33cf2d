// An error that MuJoCo reports by its error handler becomes an exception in C++ frames alone.
#include <gtest/gtest.h>

#include <string>

#include "sim/scene/model.h"

namespace lcs::sim {
namespace {

std::string error_of(const char* message) {
  try {
    call_mujoco([&] { mju_error("%s", message); });
  } catch (const MujocoError& error) {
    return error.what();
  }
  return "none";
}

TEST(MujocoErrors, ComeOutOfACallAsExceptionsWithMujocosMessage) {
  install_mujoco_handlers();
  EXPECT_EQ(error_of("first"), "first");
  EXPECT_EQ(error_of("second"), "second");
  const std::string longer(5000, 'x');
  EXPECT_TRUE(longer.starts_with(error_of(longer.c_str())));
  int calls = 0;
  call_mujoco([&] { calls = mju_isZero(nullptr, 0); });
  EXPECT_EQ(calls, 1) << "a call after an error works";
}

TEST(MujocoErrors, ReachTheInnermostCall) {
  install_mujoco_handlers();
  std::string inner, outer;
  try {
    call_mujoco([&] {
      inner = error_of("inner");
      mju_error("outer");
    });
  } catch (const MujocoError& error) {
    outer = error.what();
  }
  EXPECT_EQ(inner, "inner");
  EXPECT_EQ(outer, "outer");
}

TEST(MujocoErrorsDeathTest, OutsideOfACallEndTheProcessWithTheMessageAndTheExitCodeOfAnError) {
  install_mujoco_handlers();
  EXPECT_EXIT(mju_error("lost"), testing::ExitedWithCode(2),
              "error of MuJoCo: lost; please report");
}

}  // namespace
}  // namespace lcs::sim
