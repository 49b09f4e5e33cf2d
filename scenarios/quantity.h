/// \file
/// Numbers with units, as written in scenario files: "0.5 m/s", "3 cm/s", "9 deg", "200 ms".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lcs::scenario {

/// What a number measures. A number without a unit is in the base unit named here.
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
  intensity,     ///< cd, of a lamp
  pixels,        ///< px, along the picture
};

/// The base unit, "" for a number.
std::string_view base_unit(Dimension dimension);

/// A number of base units in SI: radians for degrees, itself for all others.
double to_si(double in_base_unit, Dimension dimension);

/// The SI value of a text such as "0.5 m/s" or "0.5". "7 cm" and "0.07 m" give the same bits.
/// \throws std::invalid_argument "what is wrong; what to do" for what is not a finite number in a
///   unit of this dimension.
double parse_quantity(std::string_view text, Dimension dimension);

/// The units of a dimension, the base unit first.
std::vector<std::string_view> units_of(Dimension dimension);

/// An SI value with its unit, as `parse_quantity` reads it, to 12 digits. \param unit of the
/// dimension; "": its base unit.
std::string quantity_text(double si, Dimension dimension, std::string_view unit = "");

/// A double in as few digits as bring it back, for messages.
std::string number_text(double value);

}  // namespace lcs::scenario
