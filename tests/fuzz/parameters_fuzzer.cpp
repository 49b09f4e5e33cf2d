// Parameters of the filter as text, "key=value" a line: refused, or the filter works with them.
#include <stdexcept>

#include "tests/filter/invariants.h"
#include "tests/filter/world.h"
#include "tests/fuzz/input.h"

namespace {

using namespace lcs;

const Intrinsics kCamera{90, {79.5, 59.5}, 160, 120};

/// Points at several depths, with some that move, of a camera that drives.
testing::World small_world() {
  testing::World world;
  world.camera = kCamera;
  testing::Random random(1);
  for (int i = 0; i < 60; ++i) {
    world.add({random.uniform(2, 157), random.uniform(2, 117)}, random.uniform(1.5, 8));
  }
  for (int i = 0; i < 12; ++i) {
    world.add({random.uniform(90, 120), random.uniform(50, 80)}, 2.5, {-0.6, 0, 0});
  }
  return world;
}

void drive(const Parameters& parameters) {
  Filter filter(kCamera, parameters);
  testing::World world = small_world();
  EgoMotion motion = testing::steady_motion({0.05, 0.02, 0.5}, {0.02, -0.05, 0.03}, 0.1);
  motion.ground = Ground{.up_C = {0, -1, 0}, .height_m = 0.8};
  for (int k = 0; k < 8; ++k) {
    const auto corners = world.corners();
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    if (const auto what = testing::violation(result, corners.size(), kCamera, parameters)) {
      fuzz::fail(*what);
    }
    world.advance(motion);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text = fuzz::text_of(data, size);
  Parameters parameters = preset("default");
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    try {
      const std::size_t equals = std::min(line.find('='), line.size());
      const std::string_view key = line.substr(0, equals);
      const std::string_view value = line.substr(std::min(equals + 1, line.size()));
      if (key == "preset") {
        parameters = preset(value);
      } else {
        set(parameters, key, value);
      }
    } catch (const std::invalid_argument&) {
      // A wrong line leaves the parameters as they are.
    }
  }
  try {
    validate(parameters);
  } catch (const std::invalid_argument&) {
    return 0;  // each is in its range, but not beside the others
  }
  drive(parameters);
  return 0;
}
