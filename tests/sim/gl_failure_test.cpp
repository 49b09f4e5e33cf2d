// What happens where GL fails: OSMesa itself, but for the calls that are told to fail.
#include <GL/osmesa.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "sim/camera_renderer.h"
#include "sim/gl_context.h"
#include "sim/world.h"
#include "tests/sim/support.h"

namespace {

bool fails_to_create = false;
bool fails_to_make_current = false;

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// The program's own come before the library's.
extern "C" OSMesaContext OSMesaCreateContextExt(GLenum format, GLint depth_bits, GLint stencil_bits,
                                                GLint accumulator_bits, OSMesaContext shared) {
  if (fails_to_create) return nullptr;
  return next<decltype(OSMesaCreateContextExt)>("OSMesaCreateContextExt")(
      format, depth_bits, stencil_bits, accumulator_bits, shared);
}
extern "C" GLboolean OSMesaMakeCurrent(OSMesaContext context, void* buffer, GLenum type,
                                       GLsizei width, GLsizei height) {
  if (fails_to_make_current) return GL_FALSE;
  return next<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent")(context, buffer, type, width,
                                                                height);
}

namespace lcs::sim {
namespace {

class GlFailure : public testing::Test {
 protected:
  ~GlFailure() override { fails_to_create = fails_to_make_current = false; }
  /// What starting GL says.
  static std::string refusal() {
    try {
      GlContext();
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "nothing";
  }
};

TEST_F(GlFailure, AtTheStartNamesTheCallAndTheRemedy) {
  EXPECT_EQ(refusal(), "nothing");
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
  ASSERT_EQ(setenv("GALLIUM_DRIVER", "nonsense", 1), 0);
  const std::string message = refusal();
  EXPECT_NE(message.find("GALLIUM_DRIVER=nonsense"), std::string::npos) << message;
  EXPECT_NE(message.find("set it to llvmpipe or softpipe"), std::string::npos) << message;
  // which it has
  ASSERT_EQ(setenv("GALLIUM_DRIVER", "softpipe", 1), 0);
  EXPECT_EQ(refusal(), "nothing");
  unsetenv("GALLIUM_DRIVER");
}

// Of two renderers the one that is not current has to become so, to draw and to let go.
TEST_F(GlFailure, BetweenFramesIsAnErrorAndTheRendererStillLetsGo) {
  World world(test::scenario_in("lab", 0, 1)), other_world(test::scenario_in("lab", 0, 1));
  std::optional<CameraRenderer> renderer(std::in_place, world.model(), world.camera_id(), 64, 48);
  CameraRenderer other(other_world.model(), other_world.camera_id(), 64, 48);
  renderer->update();
  other.update();
  cv::Mat3b image;
  fails_to_make_current = true;
  EXPECT_THROW(renderer->render_colour(image), std::runtime_error);
  EXPECT_NO_THROW(renderer.reset());
  EXPECT_NO_THROW(other.render_colour(image)) << "it is current all the time";
  EXPECT_GT(cv::countNonZero(image.reshape(1)), 0);
}

}  // namespace
}  // namespace lcs::sim
