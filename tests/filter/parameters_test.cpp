#include "filter/parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "tests/tools/refusal.h"

namespace lcs {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

template <typename Action>
std::string refusal(Action action) {
  return bench::refusal_of<std::invalid_argument>(action);
}

TEST(Parameters, LabCarriesTheTableOfThePaper) {
  const Parameters p = preset("lab");
  EXPECT_NEAR(p.circle.delta_v, 9 * kDegree, 1e-12);
  EXPECT_DOUBLE_EQ(p.circle.mu_0, 25);
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
  EXPECT_DOUBLE_EQ(p.circle.epsilon_v_n, 0.40);  // printed as 40, of V_v: read as per cent
  EXPECT_DOUBLE_EQ(p.circle.epsilon_v_r, 1.00);
  EXPECT_DOUBLE_EQ(p.square.epsilon_v, 0.7);
  EXPECT_DOUBLE_EQ(p.square.epsilon_v_s, 0.7);
  EXPECT_EQ(p.circle.edge_rule, EdgeRule::paper);
  EXPECT_TRUE(p.line.ignore);
}

TEST(Parameters, CarsChangesTheRanksOfTrust) {
  const Parameters p = preset("cars");
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
    Parameters p = preset(name);
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
  Parameters p = preset("lab");
  set(p, "circle.delta_v", "12");
  EXPECT_NEAR(p.circle.delta_v, 12 * kDegree, 1e-12);
  set(p, "circle.delta_v", "10 deg");
  EXPECT_NEAR(p.circle.delta_v, 10 * kDegree, 1e-12);
}

TEST(Parameters, AnUnknownKeyIsRefusedByName) {
  Parameters p = preset("lab");
  const std::string message = refusal([&] { set(p, "circle.mu0", "25"); });
  EXPECT_NE(message.find("circle.mu0"), std::string::npos) << message;
}

TEST(Parameters, AValueOutOfRangeIsRefusedByName) {
  Parameters p = preset("lab");
  for (const auto& [key, value] : {std::pair{"circle.mu_0", "-1"},
                                   {"circle.rho_c", "101"},
                                   {"circle.delta_v", "91"},
                                   {"field.reference_depth", "0"},
                                   {"circle.min_members", "0"}}) {
    const std::string message = refusal([&, k = key, v = value] { set(p, k, v); });
    EXPECT_NE(message.find(key), std::string::npos) << message;
  }
}

TEST(Parameters, WhatIsNotAValueIsRefusedByName) {
  Parameters p = preset("lab");
  for (const auto& [key, value] : {std::pair{"circle.mu_0", "wide"},
                                   {"circle.mu_0", "nan"},
                                   {"circle.mu_0", "inf"},
                                   {"circle.mu_0", "25 m"},
                                   {"circle.mu_0", ""},
                                   {"circle.Tr_m", "2.5"},
                                   {"line.ignore", "yes"},
                                   {"circle.edge_rule", "printed"},
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
  Parameters p = preset("lab");
  p.circle.trust = {4, 3, 5};
  EXPECT_NE(refusal([&] { validate(p); }).find("Tr_c <= Tr_s <= Tr_m"), std::string::npos);
}

TEST(Parameters, ALeastRadiusAboveTheGreatestIsRefused) {
  Parameters p = preset("lab");
  p.circle.mu_min = p.circle.mu_max;
  EXPECT_NO_THROW(validate(p));
  p.circle.mu_min = std::nextafter(p.circle.mu_max, 1e9);
  EXPECT_NE(refusal([&] { validate(p); }).find("'circle.mu_min' is above"), std::string::npos);
}

TEST(Parameters, ValidationSeesWhatWasSetInCode) {
  Parameters p = preset("default");
  p.square.rho_c = 1000;
  EXPECT_NE(refusal([&] { validate(p); }).find("square.rho_c"), std::string::npos);
}

}  // namespace
}  // namespace lcs
