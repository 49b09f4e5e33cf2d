#include "scenarios/input/reader.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <string>

#include "tests/tools/refusal.h"

namespace lcs::input {
namespace {

constexpr double pi = std::numbers::pi;

std::string refusal(std::string_view text, Dimension dimension) {
  return test::refusal_of<std::invalid_argument>([&] { parse_quantity(text, dimension); });
}

TEST(Quantity, ANumberWithoutUnitIsInTheBaseUnit) {
  EXPECT_EQ(parse_quantity("2", Dimension::length), 2);
  EXPECT_EQ(parse_quantity("-0.5", Dimension::speed), -0.5);
  EXPECT_EQ(parse_quantity("1e-4", Dimension::number), 1e-4);
  EXPECT_EQ(parse_quantity("90", Dimension::angle), pi / 2);
  EXPECT_EQ(parse_quantity("180", Dimension::angular_rate), pi);
}

TEST(Quantity, EveryUnitBecomesSi) {
  EXPECT_EQ(parse_quantity("3 m", Dimension::length), 3);
  EXPECT_EQ(parse_quantity("3 cm", Dimension::length), 0.03);
  EXPECT_EQ(parse_quantity("3 mm", Dimension::length), 0.003);
  EXPECT_EQ(parse_quantity("3 km", Dimension::length), 3000);
  EXPECT_EQ(parse_quantity("3 s", Dimension::time), 3);
  EXPECT_EQ(parse_quantity("200 ms", Dimension::time), 0.2);
  EXPECT_EQ(parse_quantity("2 min", Dimension::time), 120);
  EXPECT_EQ(parse_quantity("0.5 m/s", Dimension::speed), 0.5);
  EXPECT_EQ(parse_quantity("3 cm/s", Dimension::speed), 0.03);
  EXPECT_EQ(parse_quantity("3 mm/s", Dimension::speed), 0.003);
  EXPECT_EQ(parse_quantity("36 km/h", Dimension::speed), 10);
  EXPECT_EQ(parse_quantity("2 m/s^2", Dimension::acceleration), 2);
  EXPECT_EQ(parse_quantity("0.05 cm/s^2", Dimension::acceleration), 0.0005);
  EXPECT_EQ(parse_quantity("5 mm/s^2", Dimension::acceleration), 0.005);
  EXPECT_EQ(parse_quantity("10 Hz", Dimension::frequency), 10);
  EXPECT_EQ(parse_quantity("1 kHz", Dimension::frequency), 1000);
  EXPECT_EQ(parse_quantity("180 deg", Dimension::angle), pi);
  EXPECT_EQ(parse_quantity("1.5 rad", Dimension::angle), 1.5);
  EXPECT_EQ(parse_quantity("90 deg/s", Dimension::angular_rate), pi / 2);
  EXPECT_EQ(parse_quantity("0.2 rad/s", Dimension::angular_rate), 0.2);
  EXPECT_EQ(parse_quantity("600 px", Dimension::pixels), 600);
}

TEST(Quantity, WritingItInAnotherUnitGivesTheSameBits) {
  for (int i = 1; i <= 100; ++i) {
    const double metres =
        std::stod("0." + std::string(i < 10 ? "0" : "") + std::to_string(i % 100));
    if (i < 100) {
      EXPECT_EQ(parse_quantity(std::to_string(i) + " cm", Dimension::length), metres);
    }
  }
}

TEST(Quantity, BlanksAroundNumberAndUnitDoNotMatter) {
  EXPECT_EQ(parse_quantity("0.5m/s", Dimension::speed), 0.5);
  EXPECT_EQ(parse_quantity("  0.5   m/s ", Dimension::speed), 0.5);
}

TEST(Quantity, AUnitOfAnotherKindIsRefusedWithTheRightOnes) {
  EXPECT_EQ(refusal("5 deg", Dimension::speed),
            "'5 deg' is an angle; give a speed in m/s, cm/s, mm/s or km/h");
  EXPECT_EQ(refusal("5 m", Dimension::frequency),
            "'5 m' is a length; give a frequency in Hz or kHz");
  EXPECT_EQ(refusal("5 m", Dimension::number), "'5 m' is a length; give a number without a unit");
}

TEST(Quantity, AnUnknownUnitIsNamed) {
  EXPECT_EQ(refusal("5 furlong", Dimension::length),
            "'5 furlong' has the unknown unit 'furlong'; give a length in m, cm, mm or km");
  EXPECT_EQ(refusal("1,5 m", Dimension::length),
            "'1,5 m' has the unknown unit ',5 m'; give a length in m, cm, mm or km");
  EXPECT_EQ(refusal("5 M", Dimension::length),
            "'5 M' has the unknown unit 'M'; give a length in m, cm, mm or km");
}

TEST(Quantity, TextWithoutAFiniteNumberIsRefused) {
  for (const char* text : {"", "m", "fast", "+-1", "--1 m"}) {
    EXPECT_NE(refusal(text, Dimension::length).find("is not a number; give a length"),
              std::string::npos)
        << text;
  }
  for (const char* text : {"nan", "inf", "-inf m", "NaN m", "infinity"}) {
    EXPECT_NE(refusal(text, Dimension::length).find("is not finite; give a length"),
              std::string::npos)
        << text;
  }
  for (const char* text : {"1e999", "1e308 km"}) {
    EXPECT_NE(refusal(text, Dimension::length).find("does not fit"), std::string::npos) << text;
  }
  EXPECT_NE(refusal(".nan", Dimension::length).find("is not a number"), std::string::npos);
  EXPECT_NE(refusal(".inf", Dimension::length).find("is not a number"), std::string::npos);
}

}  // namespace
}  // namespace lcs::input
