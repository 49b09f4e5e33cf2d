/// \file
/// The keys of a scenario file for people and for editors, made from `fields.h`.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace lcs::scenario {

/// The keys that README.md has a table of their own for; that of "" has all other keys.
inline constexpr std::array<std::string_view, 10> kSections{
    "", "recording", "ego", "camera", "imu", "image", "ground", "odometry", "actors", "criteria"};

/// A table in Markdown: key, meaning, what holds without the key, and the values that it takes.
std::string keys_table(std::string_view section);

/// A JSON Schema (draft-07) of scenario files. It knows every key and the kind of its value. The
/// loader checks more: ranges of numbers with a unit, times that increase, files that exist.
std::string schema_text();

}  // namespace lcs::scenario
