/// \file
/// Numbers on the command line, read as those of a scenario are: all of the text, in range.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/reader.h"

namespace lcs::tools {

/// The text behind an option as a value of a scenario.
inline scenario::Value option_value(const std::string& name, const std::string& text) {
  return {scenario::Value::Kind::scalar, {name, 0}, text};
}

/// \param name "--seeds". \param out an integer, or an optional one. \throws scenario::Error in
/// parsing.
template <class Out>
CLI::Option* add_integer_option(CLI::App& command, const std::string& name, Out& out,
                                const std::string& about, std::int64_t low, std::int64_t high) {
  return command.add_option_function<std::string>(
      name,
      [=, &out](const std::string& text) {
        out = static_cast<int>(
            scenario::as_integer(option_value(name, text), "the number", low, high));
      },
      about);
}

/// `--seed N`. \param seed a std::uint64_t, or an optional one.
template <class Seed>
void add_seed_option(CLI::App& command, Seed& seed,
                     const std::string& about = "Seed, instead of the scenario's") {
  command
      .add_option_function<std::string>(
          "--seed",
          [&seed](const std::string& text) {
            seed = scenario::as_seed(option_value("--seed", text), "the seed");
          },
          about)
      ->type_name("N");
}

/// A number that may carry its unit; `out` is in SI, or an optional of that.
template <class Out>
CLI::Option* add_quantity_option(CLI::App& command, const std::string& name,
                                 const scenario::Quantity& quantity, Out& out,
                                 const std::string& about) {
  return command.add_option_function<std::string>(
      name,
      [=, &out](const std::string& text) {
        out = scenario::as_quantity(option_value(name, text), "the number", quantity);
      },
      about);
}

/// As many such numbers, with commas between them.
inline CLI::Option* add_quantities_option(CLI::App& command, const std::string& name,
                                          const scenario::Quantity& quantity, int count,
                                          std::vector<double>& out, const std::string& about) {
  return command
      .add_option_function<std::vector<std::string>>(
          name,
          [=, &out](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              out.push_back(scenario::as_quantity(option_value(name, text), "a number", quantity));
            }
          },
          about)
      ->delimiter(',')
      ->expected(count);
}

}  // namespace lcs::tools
