/// \file
/// Numbers with units, as written in scenario files: "0.5 m/s", "3 cm/s", "9 deg", "200 ms".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lcs::input {

/// Physical dimension. Numbers without a unit are in the base unit given here.
enum class Dimension {
  number,        ///< no unit
  length,        ///< m
  time,          ///< s
  speed,         ///< m/s
  acceleration,  ///< m/s^2
  frequency,     ///< Hz
  angle,         ///< deg
  angular_rate,  ///< deg/s
  illuminance,   ///< lx
  intensity,     ///< cd, luminous intensity of a lamp
  pixels,        ///< px, in the image
};

/// The base unit; "" for `number`.
std::string_view base_unit(Dimension dimension);

/// Converts from base units to SI: degrees to radians; all other base units are SI.
double to_si(double in_base_unit, Dimension dimension);

/// The SI value of a text such as "0.5 m/s" or "0.5". "7 cm" and "0.07 m" give the same bits.
/// \throws std::invalid_argument "problem; remedy" unless the text is a finite number in a unit of
/// this dimension.
double parse_quantity(std::string_view text, Dimension dimension);

/// The units of a dimension, the base unit first.
std::vector<std::string_view> units_of(Dimension dimension);

/// An SI value with its unit, to 12 digits, in the format of `parse_quantity`. \param unit of this
/// dimension; "": its base unit.
std::string quantity_text(double si, Dimension dimension, std::string_view unit = "");

/// The shortest text that parses to the same double, for messages.
std::string number_text(double value);

}  // namespace lcs::input
