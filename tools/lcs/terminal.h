/// \file
/// Standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/app/caller.h"
#include "tools/suite/verdict.h"

namespace lcs::tools {

/// Opens /dev/null on each closed descriptor among 0, 1 and 2. Otherwise a file opened later could
/// get that descriptor and receive the printed text.
void open_standard_descriptors();

/// Writes to standard output. \throws files::OutputError if the write fails, Interrupted if a
/// termination signal arrives while nobody reads the output.
void write_out(const std::string& text);
/// Writes to standard error and ignores failures.
void write_err(const std::string& text);

/// Writes the message to standard error as one printable line (`input::one_line`).
void tell(std::string_view message);
/// Prints each warning on a line of standard error.
void warn(const std::vector<std::string>& lines);

/// The scenario file that an argument names: its path, or of the project's scenarios the name. The
/// latter is told. \throws std::runtime_error as `scenario::shipped_scenario`.
std::filesystem::path scenario_file(const std::string& named);

template <class... Args>
void print_out(fmt::format_string<Args...> format, Args&&... args) {
  write_out(fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void print_err(fmt::format_string<Args...> format, Args&&... args) {
  write_err(fmt::format(format, std::forward<Args>(args)...));
}

/// The text in a colour, if standard output is a terminal and the environment neither sets
/// NO_COLOR (no-color.org) nor says that the terminal is dumb.
std::string coloured(const std::string& text, suite::Light light);

/// Shows on stderr what a function of the library says, and ends it after a signal. Of a suite it
/// shows a line per finished run, and on a terminal a status line.
class Terminal : public app::Caller {
 public:
  /// \param quiet prints only errors and warnings.
  explicit Terminal(bool quiet) : quiet_(quiet) {}
  /// Erases the status line.
  ~Terminal() override { Terminal::wipe(); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void check() override;
  void tell(const std::string& line) override { tools::tell(line); }
  void note(const std::string& line) override;
  void warn(const std::vector<std::string>& lines) override { tools::warn(lines); }
  std::unique_ptr<app::Progress> progress(const std::string& name, int total,
                                          const std::string& unit) override;
  void finished(const suite::SuiteProgress& progress, const std::string& scenario,
                const std::vector<std::string>& detectors,
                std::span<const suite::RunResult* const> runs) override;
  void show(const suite::SuiteProgress& progress) override;
  void wipe() override;

 private:
  bool quiet_;
  bool is_shown_ = false;  ///< the status line
  std::chrono::steady_clock::time_point shown_{};
};

/// Flushes std::cout and stdout. \throws as `write_out`.
void finish_out();

}  // namespace lcs::tools
