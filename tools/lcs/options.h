/// \file
/// Options that several sub-commands have. Numbers are read as those of a scenario are: all of the
/// text, in range.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/reader.h"
#include "tools/files/output.h"

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

/// Makes every sub-command refuse an empty value of an option or argument. It is a slip, such as a
/// shell variable that is not set, and does not mean the same as an option that is not given.
inline void refuse_empty_options(CLI::App& app) {
  const auto complaint = [](const std::string& text) -> std::string {
    return text.empty() ? "is given without a value; give one, or leave it out" : "";
  };
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) option->check(complaint, "");
    }
  }
}

/// One setting behind each `--set`, so that what follows it is not taken for another.
inline void add_set_option(CLI::App& command, std::vector<std::string>& sets,
                           const std::string& about) {
  command.add_option("--set", sets, about + "; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

/// Key and value of a setting of the filter, as `--set` has it where it is not a scenario's.
/// \throws std::invalid_argument
inline std::pair<std::string, std::string> key_and_value(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    throw std::invalid_argument("--set takes KEY=VALUE, as hypotheses.prior=0.05, not '" + setting +
                                "'");
  }
  return {setting.substr(0, equals), setting.substr(equals + 1)};
}

/// The heading in the help of all options that name what is written. Each goes through
/// `bench::Output`, or `bench::output_path` where a folder grows.
inline constexpr const char* kOutputs = "Outputs";

/// \param otherwise the folder of the results where none is given.
inline void add_out_option(CLI::App& command, std::string& out, const std::string& otherwise) {
  command.add_option("--out", out, "Folder for the results; " + otherwise + " if not given")
      ->type_name("DIR")
      ->group(kOutputs);
}

/// An option that names a single file, and `--force` beside the first of a command.
inline void add_output_file_option(CLI::App& command, const std::string& name, std::string& out,
                                   bool& force, const std::string& about) {
  command.add_option(name, out, about)->type_name("FILE")->group(kOutputs);
  if (command.get_option_no_throw("--force") != nullptr) return;
  command
      .add_flag("--force", force,
                "Replace a file that lcs has not written, or that was changed since")
      ->group(kOutputs);
}

/// How a file that is named may be replaced.
inline bench::Overwrite overwrite(bool force) {
  return force ? bench::Overwrite::any_file : bench::Overwrite::own_or_forced;
}

/// What a run leaves beside its figures.
inline void add_result_options(CLI::App& command, bool& no_video, bool& events) {
  command.add_flag("--no-video", no_video, "Write no video.mp4");
  command.add_flag("--events", events,
                   "Write events.json: where rebels were missed or false, why, and pictures of it");
}

inline void add_quiet_option(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet", quiet, "Print nothing but what went wrong");
}

}  // namespace lcs::tools
