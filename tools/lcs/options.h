/// \file
/// Options shared by several sub-commands. Numbers are parsed as in a scenario file: the whole text
/// must be a number within the range.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/shipped.h"
#include "tools/files/output.h"
#include "tools/input/reader.h"
#include "tools/lcs/terminal.h"
#include "tools/output/result.h"

namespace lcs::tools {

/// Converts an option's text to a scenario value.
inline input::Value option_value(const std::string& name, const std::string& text) {
  return {input::Value::Kind::scalar, {name, 0}, text};
}

/// \param name such as "--seeds". \param out an integer or an optional of one.
/// Parsing throws input::Error.
template <class Out>
CLI::Option* add_integer_option(CLI::App& command, const std::string& name, Out& out,
                                const std::string& about, std::int64_t low, std::int64_t high) {
  return command.add_option_function<std::string>(
      name,
      [=, &out](const std::string& text) {
        out =
            static_cast<int>(input::as_integer(option_value(name, text), "the number", low, high));
      },
      about);
}

/// Adds `--seed N`. \param seed a std::uint64_t or an optional of one.
template <class Seed>
void add_seed_option(CLI::App& command, Seed& seed,
                     const std::string& about = "Seed, instead of the scenario's") {
  command
      .add_option_function<std::string>(
          "--seed",
          [&seed](const std::string& text) {
            seed = input::as_seed(option_value("--seed", text), "the seed");
          },
          about)
      ->type_name("N");
}

/// Adds an option for a number with or without a unit. \param out in SI units, or an optional.
template <class Out>
CLI::Option* add_quantity_option(CLI::App& command, const std::string& name,
                                 const input::Quantity& quantity, Out& out,
                                 const std::string& about) {
  return command.add_option_function<std::string>(
      name,
      [=, &out](const std::string& text) {
        out = input::as_quantity(option_value(name, text), "the number", quantity);
      },
      about);
}

/// Makes every sub-command reject an empty value of an option or argument. An empty value usually
/// comes from an unset shell variable and must not be treated like an absent option.
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

/// The scenario file that an argument names: its path, or of the project's scenarios the name. The
/// latter is told. \throws std::runtime_error as `scenario::shipped_scenario`.
inline std::filesystem::path scenario_file(const std::string& named) {
  const auto shipped = scenario::shipped_scenario(named);
  if (shipped) tell(named + " is " + shipped->string());
  return shipped.value_or(named);
}

/// Adds `--set`. It takes one value, so that a positional argument may follow it.
inline void add_set_option(CLI::App& command, std::vector<std::string>& sets,
                           const std::string& about) {
  command.add_option("--set", sets, about + "; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

/// Help heading of all options that name output files. Each such path goes through
/// `bench::Output`, or through `bench::output_path` for a folder that is filled step by step.
inline constexpr const char* kOutputs = "Outputs";

/// Adds `--out`. \param otherwise the default folder, named in the help.
inline void add_out_option(CLI::App& command, std::string& out, const std::string& otherwise) {
  command.add_option("--out", out, "Folder for the results; " + otherwise + " if not given")
      ->type_name("DIR")
      ->group(kOutputs);
}

/// Adds an option for a single output file, and `--force` with the first such option of a command.
inline void add_output_file_option(CLI::App& command, const std::string& name, std::string& out,
                                   bool& force, const std::string& about) {
  command.add_option(name, out, about)->type_name("FILE")->group(kOutputs);
  if (command.get_option_no_throw("--force") != nullptr) return;
  command
      .add_flag("--force", force,
                "Replace a file of the same name that lcs did not write, or that was edited since")
      ->group(kOutputs);
}

/// Whether an existing output file may be replaced.
inline bench::Overwrite overwrite(bool force) {
  return force ? bench::Overwrite::any_file : bench::Overwrite::own_or_forced;
}

/// Adds the options that choose a run's output files besides its figures.
inline void add_result_options(CLI::App& command, bool& no_video, bool& events) {
  command.add_flag("--no-video", no_video, "Write no video.mp4");
  command.add_flag("--events", events,
                   "Write events.json: missed and false rebels, with reasons and pictures");
}

/// Adds `--keep`.
inline CLI::Option* add_keep_option(CLI::App& command, bench::Keep& keep) {
  return command
      .add_option_function<std::string>(
          "--keep", [&keep](const std::string& text) { keep = bench::keep_of(text); },
          "The files of each run: figures; events: also a row a frame and the events; all: also "
          "layers, truth and pictures, for --recorded")
      ->type_name("WHAT");
}

/// Adds `--threads`.
inline CLI::Option* add_threads_option(CLI::App& command, int& threads) {
  return add_integer_option(
             command, "--threads", threads,
             "1 or 2; with 2 the next frame is made, and its corners are found, while "
             "a second thread filters and writes this one: the same results on two "
             "cores, sooner. If not given, 1",
             1, 2)
      ->type_name("N");
}

inline void add_quiet_option(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet", quiet, "Print only errors and warnings");
}

}  // namespace lcs::tools
