#include "filter/paper/any_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

#include "filter/types/learnt.h"
#include "tests/tools/refusal.h"

namespace lcs {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

template <typename Action>
std::string refusal(Action action) {
  return test::refusal_of<std::invalid_argument>(action);
}

TEST(Parameters, LabCarriesTheTableOfThePaper) {
  const paper::PaperParameters p;
  EXPECT_NEAR(p.edge.delta_v, 9 * kDegree, 1e-12);
  EXPECT_DOUBLE_EQ(p.edge.mu_0, 25);
  EXPECT_DOUBLE_EQ(p.circle.rho_c, 40);
  EXPECT_DOUBLE_EQ(p.square.rho_c, 40);
  EXPECT_EQ(p.circle.trust.critical, 2);
  EXPECT_EQ(p.circle.trust.standard, 3);
  EXPECT_EQ(p.circle.trust.maximum, 5);
  EXPECT_EQ(p.square.trust.critical, 3);
  EXPECT_EQ(p.square.trust.standard, 5);
  EXPECT_EQ(p.square.trust.maximum, 7);
  EXPECT_NEAR(p.circle.epsilon_beta_n, 20 * kDegree, 1e-12);
  EXPECT_NEAR(p.circle.epsilon_beta_r, 50 * kDegree, 1e-12);
  EXPECT_NEAR(p.square.delta_beta_1, 90 * kDegree, 1e-12);
  EXPECT_NEAR(p.square.epsilon_beta_1, 15 * kDegree, 1e-12);
  EXPECT_NEAR(p.square.epsilon_beta_2, 35 * kDegree, 1e-12);
  EXPECT_NEAR(p.square.epsilon_beta_s, 20 * kDegree, 1e-12);
  EXPECT_NEAR(p.square.epsilon_beta, 20 * kDegree, 1e-12);
  EXPECT_DOUBLE_EQ(p.circle.epsilon_v_n, 0.40);  // printed as 40 of V_v: taken as per cent
  EXPECT_DOUBLE_EQ(p.circle.epsilon_v_r, 1.00);
  EXPECT_DOUBLE_EQ(p.square.epsilon_v, 0.7);
  EXPECT_DOUBLE_EQ(p.square.epsilon_v_s, 0.7);
  EXPECT_TRUE(p.ignore);
}

TEST(Parameters, CarsChangesTheRanksOfTrust) {
  const paper::PaperParameters p = paper::cars();
  EXPECT_EQ(p.circle.trust.critical, 1);
  EXPECT_EQ(p.circle.trust.standard, 4);
  EXPECT_EQ(p.circle.trust.maximum, 7);
  EXPECT_EQ(p.square.trust.critical, 2);
  EXPECT_EQ(p.square.trust.standard, 5);
  EXPECT_EQ(p.square.trust.maximum, 8);
}

TEST(Parameters, EveryPresetIsValid) {
  for (const std::string& name : preset_names()) {
    SCOPED_TRACE(name);
    EXPECT_NO_THROW(validate(preset(name)));
  }
}

TEST(Parameters, EveryParameterCanBeSetToWhatItIs) {
  for (const std::string& name : preset_names()) {
    AnyParameters p = preset(name);
    std::set<std::string> keys;
    for (const ParameterInfo& info : describe(p)) {
      SCOPED_TRACE(info.key);
      EXPECT_TRUE(keys.insert(info.key).second) << "listed twice";
      EXPECT_NO_THROW(set(p, info.key, info.value));
    }
    const auto before = describe(preset(name)), after = describe(p);
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(before[i].value, after[i].value) << before[i].key;
    }
  }
}

TEST(Parameters, AnglesAreDegreesInTextAndRadiansInside) {
  paper::PaperParameters p;
  set(p, "circle.delta_v", "12");
  EXPECT_NEAR(p.edge.delta_v, 12 * kDegree, 1e-12);
  set(p, "circle.delta_v", "10 deg");
  EXPECT_NEAR(p.edge.delta_v, 10 * kDegree, 1e-12);
}

TEST(Parameters, AnUnknownKeyIsRefusedByName) {
  paper::PaperParameters p;
  const std::string message = refusal([&] { set(p, "circle.mu0", "25"); });
  EXPECT_NE(message.find("circle.mu0"), std::string::npos) << message;
}

TEST(Parameters, AValueOutOfRangeIsRefusedByName) {
  paper::PaperParameters p;
  for (const auto& [key, value] : {std::pair{"circle.mu_0", "-1"},
                                   {"circle.rho_c", "101"},
                                   {"circle.delta_v", "91"},
                                   {"field.reference_depth", "0"},
                                   {"circle.min_members", "0"}}) {
    const std::string message = refusal([&, k = key, v = value] { set(p, k, v); });
    EXPECT_NE(message.find(key), std::string::npos) << message;
  }
}

TEST(Parameters, InvalidValueIsRefusedByName) {
  paper::PaperParameters p;
  for (const auto& [key, value] : {std::pair{"circle.mu_0", "wide"},
                                   {"circle.mu_0", "nan"},
                                   {"circle.mu_0", "inf"},
                                   {"circle.mu_0", "25 m"},
                                   {"circle.mu_0", ""},
                                   {"circle.Tr_m", "2.5"},
                                   {"line.ignore", "yes"},
                                   {"field.rotation", "2"}}) {
    const std::string message = refusal([&, k = key, v = value] { set(p, k, v); });
    EXPECT_NE(message.find(key), std::string::npos) << key << " = " << value << ": " << message;
  }
}

TEST(Parameters, AnUnknownPresetIsRefusedWithTheKnownOnes) {
  const std::string message = refusal([] { preset("office"); });
  for (const std::string& name : preset_names()) {
    EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

TEST(Parameters, RanksOfTrustOutOfOrderAreRefused) {
  paper::PaperParameters p;
  p.circle.trust = {4, 3, 5};
  EXPECT_NE(refusal([&] { validate(p); }).find("Tr_c <= Tr_s <= Tr_m"), std::string::npos);
}

TEST(Parameters, ALeastRadiusAboveTheGreatestIsRefused) {
  paper::PaperParameters p;
  p.edge.mu_min = p.edge.mu_max;
  EXPECT_NO_THROW(validate(p));
  p.edge.mu_min = std::nextafter(p.edge.mu_max, 1e9);
  EXPECT_NE(refusal([&] { validate(p); }).find("'circle.mu_min' is above"), std::string::npos);
}

TEST(Parameters, ValidationChecksValuesThatWereSetInCode) {
  Parameters p;
  p.square.max_size = 1e6;
  EXPECT_NE(refusal([&] { validate(p); }).find("square.max_size"), std::string::npos);
}

/// Lists each value, so that a changed default fails here.
TEST(Parameters, DefaultConstructedOnesAreThePresetDefault) {
  std::map<std::string, std::string> values;
  for (const ParameterInfo& info : describe(Parameters{})) values[info.key] = info.value;
  const std::map<std::string, std::string> expected = {
      {"circle.Tr_c", "2"},
      {"circle.Tr_m", "7"},
      {"circle.Tr_s", "3"},
      {"circle.gap", "0.2"},
      {"circle.min_members", "7"},
      {"circle.min_width", "1.5"},
      {"circle.roughness", "0.05"},
      {"circle.upward", "0.45"},
      {"comers.count_power", "0.3"},
      {"comers.hanging", "0.003"},
      {"comers.memory", "2"},
      {"field.ground", "true"},
      {"field.nearest_depth", "0.4"},
      {"field.reference_depth", "3"},
      {"field.rotation", "homography"},
      {"field.still_speed", "0.005"},
      {"hypotheses.coast", "3"},
      {"hypotheses.crossings", "2"},
      {"hypotheses.max_speed", "900"},
      {"hypotheses.neighbours", "9"},
      {"hypotheses.slide", "0.15"},
      {"line.max_corners", "20000"},
      {"square.max_size", "5"},
  };
  for (const auto& [key, value] : expected) EXPECT_EQ(values[key], value) << key;
  for (const auto& [key, value] : kLearnt) EXPECT_EQ(std::stod(values[key]), value) << key;
  EXPECT_EQ(values.size(), expected.size() + kLearnt.size());
  const auto of_preset = describe(preset("default"));
  ASSERT_EQ(of_preset.size(), values.size());
  for (const ParameterInfo& info : of_preset) EXPECT_EQ(values[info.key], info.value) << info.key;
}

}  // namespace
}  // namespace lcs
