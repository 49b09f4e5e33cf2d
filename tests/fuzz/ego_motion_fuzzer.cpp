// The ego-motion estimator with arbitrary readings at arbitrary times, and the filter behind it.
#include <array>

#include "filter/ego_motion/estimator.h"
#include "filter/ego_motion/intake.h"
#include "filter/kinematics/geometry.h"
#include "tests/filter/invariants.h"
#include "tests/filter/world.h"
#include "tests/fuzz/input.h"

namespace {

using namespace lcs;
using fuzz::Bytes;

const Intrinsics kCamera{90, {79.5, 59.5}, 160, 120};
constexpr std::int64_t kStep_ns = 5'000'000;
constexpr int kMostEvents = 4000;

/// Usually the next time step.
std::int64_t next_time(Bytes& bytes, std::int64_t t_ns) {
  static constexpr std::array<std::int64_t, 10> kTempting = {
      0,
      -1,
      1,
      std::numeric_limits<std::int64_t>::max(),
      std::numeric_limits<std::int64_t>::min(),
      1'000'000'000'000'000'000,
      59'000'000'000,
      61'000'000'000,
      -61'000'000'000,
      3600'000'000'000,
  };
  const std::uint8_t how = bytes.byte();
  if (how < 224) return t_ns;
  if (how < 240) return kTempting[how % kTempting.size()];
  std::int64_t sum = 0;
  return __builtin_add_overflow(t_ns, kTempting[how % kTempting.size()], &sum) ? t_ns : sum;
}

Eigen::Vector3d vector(Bytes& bytes, double unit) {
  const double x = bytes.number(unit), y = bytes.number(unit);
  return {x, y, bytes.number(unit)};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  Mounting mounting;
  mounting.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mounting.p_BC_m = {0.2, 0, 0.4};
  mounting.on_ground = true;
  EgoMotionEstimator estimator(mounting, {}, {});
  const Parameters parameters;
  Filter filter(kCamera, parameters);
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < 40; ++i) {
    corners.emplace_back(static_cast<float>(4 * i), static_cast<float>(i * i % 117));
  }
  std::int64_t clock_ns = 0;
  for (int i = 0; i < kMostEvents && !bytes.empty(); ++i) {
    const std::uint8_t event = bytes.byte();
    if (event & 1 && clock_ns < 1'000'000'000'000) clock_ns += kStep_ns;
    const std::int64_t t_ns = next_time(bytes, clock_ns);
    if (event >= 128 + 64) {
      const EgoMotion motion = estimator.frame(t_ns);
      fuzz::require(std::isfinite(motion.dt_s) && motion.v_C_mps.allFinite() &&
                        motion.w_C_radps.allFinite() && is_rotation(motion.R_cur_prev),
                    "the motion is finite");
      const FrameResult& result = filter.step(corners, motion);
      if (const auto what = testing::violation(result, corners.size(), kCamera, parameters)) {
        fuzz::fail(*what);
      }
    } else if (event >= 128 + 32) {
      estimator.add_odometry(t_ns, vector(bytes, 0.5));
    } else {
      const Eigen::Vector3d gravity(0, 0, event & 2 ? 9.81 : event & 4 ? 1 : 0);
      estimator.add_imu(t_ns, vector(bytes, 0.2), gravity + vector(bytes, 0.1));
    }
    fuzz::require(estimator.v_WS_mps().allFinite() && is_rotation(estimator.R_WS()),
                  "what is known is finite");
  }
  return 0;
}
