/// \file
/// Parameters by name: conversion from and to text, with ranges. A filter lists its parameters
/// once, as entries that point into its struct.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "filter/parameters.h"
#include "filter/types/trust.h"

namespace lcs {

/// A parameter: name, range and address.
struct ParameterEntry {
  std::string key;
  std::string symbol;  ///< the paper's; "" if none
  std::string unit;    ///< values of unit "deg" are radians in the struct
  double min = 0, max = 0;
  std::variant<double*, int*, bool*, RotationModel*> value;
};

/// \throws std::invalid_argument like `set(Parameters&, ...)`.
void set(std::span<const ParameterEntry> entries, std::string_view key, std::string_view value);

/// \throws std::invalid_argument like `validate(const Parameters&)`.
void validate(std::span<const ParameterEntry> entries);
void validate(const TrustRanks& ranks, const std::string& expert);

std::vector<ParameterInfo> describe(std::span<const ParameterEntry> entries);

/// The entries of the motion field's parameters.
std::vector<ParameterEntry> entries_of(FieldParameters& field);

}  // namespace lcs
