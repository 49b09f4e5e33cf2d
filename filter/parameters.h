/// \file
/// Every number that the filter can be tuned by, by expert, with the paper's symbol and table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lcs {

struct Parameters;

/// Preset by name: "default", or the paper's "lab" (Table 1) and "cars" (section 5.2).
/// \throws std::invalid_argument naming the known presets.
Parameters preset(std::string_view name);

/// Sets one parameter from text, as in set(p, "circle.mu_0", "25").
/// \throws std::invalid_argument: unknown key (with the nearest known one), not a number, out of range.
void set(Parameters& parameters, std::string_view key, std::string_view value);

struct Parameters {};

}  // namespace lcs
