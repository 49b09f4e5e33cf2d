/// \file
/// Parameters by name: text to value and back, with ranges. A filter lists its parameters once, as
/// entries that point into its struct.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "filter/parameters.h"
#include "filter/trust.h"

namespace lcs {

/// A parameter: its name, its range, and where it is.
struct Entry {
  std::string key;
  std::string symbol;  ///< the paper's; "" where it has none
  std::string unit;    ///< values of unit "deg" are radians in the struct
  double min = 0, max = 0;
  std::variant<double*, int*, bool*, RotationModel*> value;
};

/// \throws std::invalid_argument as the `set` of parameters.
void set(std::span<const Entry> entries, std::string_view key, std::string_view value);

/// \throws std::invalid_argument as the `validate` of parameters.
void validate(std::span<const Entry> entries);
void validate(const TrustRanks& ranks, const std::string& expert);

std::vector<ParameterInfo> describe(std::span<const Entry> entries);

/// The entries of a motion field.
std::vector<Entry> entries_of(FieldParameters& field);

}  // namespace lcs
