/// \file
/// Documentation of the keys of a scenario file, and its JSON Schema, generated from `fields.h`.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace lcs::scenario {

/// Keys with a separate table in README.md; the table of "" has all other keys.
inline constexpr std::array<std::string_view, 10> kSections{
    "", "recording", "ego", "camera", "imu", "image", "ground", "odometry", "actors", "criteria"};

/// A Markdown table: key, meaning, effect of omitting the key, and accepted values.
std::string keys_table(std::string_view section);

/// A JSON Schema (draft-07) of scenario files, with every key and the kind of its value. The loader
/// also checks ranges of numbers with a unit, the order of times, and that files exist.
std::string schema_text();

}  // namespace lcs::scenario
