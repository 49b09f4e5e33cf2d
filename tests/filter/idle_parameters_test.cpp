/// Whether the filter tells truly which of its parameters are in use: those said to be idle change
/// no bit of what it says on a drive that has everything, and of the others each changes something.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <type_traits>

#include "filter/filter.h"
#include "filter/parameters.h"
#include "tests/filter/presets.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::Random;

struct Shot {
  std::vector<Eigen::Vector2f> corners;
  std::vector<Signature> signatures;
  EgoMotion motion;
};

/// Noisy corners that come and go: a static crowd, one that crosses on the ground, one that comes
/// on aloft, one far away, one that hardly moves. The rover turns, and in one frame unseen; once it
/// nearly stands.
std::vector<Shot> everything() {
  constexpr int kFrames = 24, kSlow = 9, kUnseen = 14;
  Random random(7);
  testing::World world;
  const auto crowd = [&](int count, Vec2 low, Vec2 high, double near, double far,
                         Eigen::Vector3d velocity) {
    for (int i = 0; i < count; ++i) {
      const Vec2 px(random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()));
      world.add(px, random.uniform(near, far), velocity);
    }
  };
  crowd(220, {5, 60}, {635, 300}, 1.5, 8, {0, 0, 0});
  crowd(60, {5, 300}, {635, 475}, 0.9, 1.4, {0, 0, 0});
  crowd(40, {400, 200}, {450, 330}, 2, 2.1, {-0.6, 0, 0});
  crowd(30, {250, 120}, {330, 170}, 4, 4.1, {0.02, 0, -1.2});
  crowd(20, {100, 180}, {140, 230}, 5, 5.2, {1.2, 0, 0});
  crowd(20, {520, 180}, {560, 230}, 3, 3.1, {-0.04, 0, 0});

  std::vector<Shot> shots;
  for (int k = 0; k < kFrames; ++k) {
    Shot& shot = shots.emplace_back();
    const double speed = k == kSlow ? 0.004 : 0.5;
    EgoMotion motion = testing::steady_motion({0.02, 0, speed}, {0.01, -0.06, 0.01}, 0.1);
    motion.ground = Ground{.up_C = {0, -1, 0}, .height_m = 0.45};
    if (k > 0) {
      world.advance(motion);
      shot.motion = motion;
    }
    if (k == kUnseen) {
      shot.motion.R_cur_prev = testing::rotation({0, 0.02, 0}) * shot.motion.R_cur_prev;
      shot.motion.unseen_turn_rad = 0.05;
    }
    const auto corners = world.corners();
    const auto signatures = world.signatures(k);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector3d noise = random.vector(0.6);
      if (random.uniform(0, 1) >= 0.9) continue;
      shot.corners.emplace_back(corners[i] + noise.head<2>().cast<float>());
      shot.signatures.push_back(signatures[i]);
    }
  }
  return shots;
}

/// The bits of all that a frame's result says.
class Digest {
 public:
  explicit Digest(const FrameResult& result) {
    for (const Verdict verdict : result.verdicts) add(verdict);
    for (const Reason reason : result.reasons) add(reason);
    const Layers& layers = result.layers;
    for (const auto* edges : {&layers.normal_edges, &layers.rebel_edges}) {
      for (const Edge& e : *edges) {
        add(e.id, e.location, e.origin, e.rotated, e.predicted, e.speed, e.depth_ratio, e.angle,
            e.mu, e.trust, e.age, e.depth_ratio_sigma, e.corner, e.circle);
      }
      add(edges->size());
    }
    for (const auto* circles : {&layers.normal_circles, &layers.rebel_circles}) {
      for (const Circle& c : *circles) {
        add(c.id, c.location, c.origin, c.radius, c.speed, c.depth_ratio, c.angle, c.trust, c.age,
            c.members, c.ignoring);
      }
      add(circles->size());
    }
    for (const Square& s : layers.squares) {
      add(s.id, s.location, s.half_size, s.origin, s.speed, s.depth_ratio, s.angle, s.trust, s.age,
          s.circles, s.rebel_circles, s.ignoring);
    }
    for (const IgnoreRegion& region : layers.ignored) add(region.location, region.size);
    for (const Collector& c : layers.collectors) add(c.location, c.radius, c.depth_ratio);
    for (const Chain& c : layers.chains) add(c.sightings[0], c.count, c.off_field_px);
  }
  bool operator==(const Digest&) const = default;

 private:
  template <typename... Values>
  void add(const Values&... values) {
    (add_one(values), ...);
  }
  void add_one(const Vec2& x) { add(x.x(), x.y()); }
  template <typename Value>
  void add_one(const Value& value) {
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    const char* first = reinterpret_cast<const char*>(&value);
    bits_.append(first, sizeof(Value));
  }
  std::string bits_;
};

std::vector<Digest> said(const std::vector<Shot>& shots, const Parameters& parameters) {
  Filter filter(testing::vga(), parameters);
  std::vector<Digest> all;
  for (const Shot& shot : shots)
    all.emplace_back(filter.step(shot.corners, shot.signatures, shot.motion));
  return all;
}

bool says_else(const std::vector<Shot>& shots, const Parameters& parameters,
               const std::vector<Digest>& usual) {
  Filter filter(testing::vga(), parameters);
  for (std::size_t k = 0; k < shots.size(); ++k) {
    const Shot& shot = shots[k];
    if (Digest(filter.step(shot.corners, shot.signatures, shot.motion)) != usual[k]) return true;
  }
  return false;
}

/// Other values that a parameter may have, as text, near ones first.
std::vector<std::string> other_values(const ParameterInfo& info) {
  std::vector<std::string> values;
  const std::size_t to = info.range.find(" to ");
  if (to == std::string::npos) {  // words with commas between them
    for (std::size_t first = 0; first < info.range.size();) {
      const std::size_t comma = std::min(info.range.find(", ", first), info.range.size());
      values.push_back(info.range.substr(first, comma - first));
      first = comma + 2;
    }
  } else {
    const double low = std::stod(info.range.substr(0, to));
    const double high = std::stod(info.range.substr(to + 4));
    const double value = std::stod(info.value);
    for (const double other : {1.2 * value, 2 * value + 1, 0.5 * value, low, 20 * value + 20}) {
      const double there = std::clamp(other, low, high);
      const auto whole = std::llround(there);
      // of a whole number the first is refused
      values.push_back(std::to_string(there));
      if (static_cast<double>(whole) != there) values.push_back(std::to_string(whole));
    }
  }
  std::erase(values, info.value);
  return values;
}

/// Those in use that this drive does not bring to bear.
const std::map<std::string, std::string> kNotOnThisDrive{
    {"circle.epsilon_v_r", "of rebels as fast as these, half of the speed is more"},
    {"square.mix_kinds", "the paper's rule finds no rebels here that move as normal circles do"},
};

/// The others have the rules of one of these.
struct IdleParameters : testing::OfEachPreset {};
INSTANTIATE_TEST_SUITE_P(Presets, IdleParameters, ::testing::Values("default", "lab"),
                         testing::name_of_preset);

TEST_P(IdleParameters, ChangeNothingAndTheOthersDo) {
  const std::vector<Shot> shots = everything();
  const std::vector<Digest> usual = said(shots, parameters());
  std::set<std::string> idle_ones, without_effect;
  for (const ParameterInfo& info : describe(parameters())) {
    SCOPED_TRACE(info.key);
    const bool is_idle = idle(parameters(), info.key).has_value();
    if (is_idle) idle_ones.insert(info.key);
    bool has_effect = false;
    for (const std::string& value : other_values(info)) {
      if (has_effect) break;
      Parameters changed = parameters();
      try {
        set(changed, info.key, value);
        validate(changed);
      } catch (const std::invalid_argument&) {
        continue;  // not of its kind, or not beside the others
      }
      has_effect = says_else(shots, changed, usual);
    }
    EXPECT_FALSE(is_idle && has_effect) << "is said to have no effect";
    if (!has_effect) without_effect.insert(info.key);
  }
  EXPECT_FALSE(idle_ones.empty());
  for (const std::string& key : without_effect) {
    EXPECT_TRUE(idle_ones.contains(key) || kNotOnThisDrive.contains(key))
        << key << " has no effect";
  }
}

TEST(Idle, IsToldWithTheRulesAndThePresetsThatAskForIt) {
  const std::optional<Idle> mu_0 = idle(preset("default"), "circle.mu_0");
  ASSERT_TRUE(mu_0);
  ASSERT_EQ(mu_0->rules.size(), 1u);
  EXPECT_EQ(mu_0->rules[0].key, "circle.edge_rule");
  EXPECT_EQ(mu_0->rules[0].value, "paper");
  EXPECT_EQ(mu_0->presets, (std::vector<std::string>{"lab", "cars"}));
  Parameters mixed = preset("default");
  set(mixed, "circle.edge_rule", "paper");
  EXPECT_FALSE(idle(mixed, "circle.mu_0"));
  EXPECT_TRUE(idle(mixed, "hypotheses.prior"));
  EXPECT_FALSE(idle(mixed, "square.max_size"));
  EXPECT_TRUE(idle(mixed, "field.ground"));
  EXPECT_THROW(idle(mixed, "circle.mu0"), std::invalid_argument);
}

}  // namespace
}  // namespace lcs
