// Behaviour when GL fails: uses OSMesa itself, except for the calls that a test makes fail.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <optional>

#include "sim/camera/gl_context.h"
#include "sim/camera/lens_renderer.h"
#include "sim/world/world.h"
#include "tests/sim/support.h"
#include "tests/tools/refusal.h"

namespace {

bool fails_to_create = false;
bool fails_to_make_current = false;

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// A program's symbols come before those of its libraries.
extern "C" void* OSMesaCreateContextExt(unsigned format, int depth_bits, int stencil_bits,
                                        int accumulator_bits, void* shared) {
  if (fails_to_create) return nullptr;
  return next<decltype(OSMesaCreateContextExt)>("OSMesaCreateContextExt")(
      format, depth_bits, stencil_bits, accumulator_bits, shared);
}
extern "C" unsigned char OSMesaMakeCurrent(void* context, void* buffer, unsigned type, int width,
                                           int height) {
  if (fails_to_make_current) return 0;
  return next<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent")(context, buffer, type, width,
                                                                height);
}

namespace lcs::sim {
namespace {

class GlFailure : public testing::Test {
 protected:
  ~GlFailure() override { fails_to_create = fails_to_make_current = false; }
  /// The error message of starting GL.
  static std::string refusal() {
    return lcs::test::refusal_of<std::runtime_error>([] { GlContext(); });
  }
};

TEST_F(GlFailure, AtTheStartNamesTheCallAndTheRemedy) {
  EXPECT_EQ(refusal(), "nothing was refused");
  fails_to_make_current = true;
  EXPECT_NE(refusal().find("OSMesaMakeCurrent"), std::string::npos);
  fails_to_create = true;
  const std::string message = refusal();
  EXPECT_NE(message.find("OSMesaCreateContextExt"), std::string::npos) << message;
  EXPECT_NE(message.find("libosmesa6"), std::string::npos) << message;
}

TEST_F(GlFailure, AtTheStartOfASimulationIsAnErrorOfTheMachine) {
  fails_to_create = true;
  EXPECT_THROW(Simulation(test::scenario_in("lab", 0, 1)), std::runtime_error);
}

TEST_F(GlFailure, ADriverThatMesaLacksIsNamedInsteadOfACrash) {
  // in a separate process, because Mesa chooses its driver only once
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto with_driver = [](const char* driver) {
    ::setenv("GALLIUM_DRIVER", driver, 1);
    std::fputs(refusal().c_str(), stderr);
    std::_Exit(0);
  };
  EXPECT_EXIT(with_driver("nonsense"), testing::ExitedWithCode(0),
              "GALLIUM_DRIVER=nonsense .*; unset it, or set it to llvmpipe or softpipe");
  EXPECT_EXIT(with_driver("softpipe"), testing::ExitedWithCode(0), "^nothing was refused$");
}

// A renderer that is not current must become current to draw and to release its context.
TEST_F(GlFailure, BetweenFramesIsAnErrorAndTheRendererStillLetsGo) {
  World world(test::scenario_in("lab", 0, 1)), other_world(test::scenario_in("lab", 0, 1));
  const Pinhole camera = Pinhole::from_fovy(64, 48, 1);
  std::optional<LensRenderer> renderer(std::in_place, world.model(), world.camera_id(), camera);
  LensRenderer other(other_world.model(), other_world.camera_id(), camera);
  renderer->update();
  other.update();
  cv::Mat3f image;
  fails_to_make_current = true;
  EXPECT_THROW(renderer->render_light(image), std::runtime_error);
  EXPECT_NO_THROW(renderer.reset());
  EXPECT_NO_THROW(other.render_light(image)) << "it is current all the time";
  EXPECT_GT(cv::countNonZero(image.reshape(1)), 0);
}

}  // namespace
}  // namespace lcs::sim
