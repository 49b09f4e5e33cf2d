#include "tools/lcs/terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <stdio_ext.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <mutex>

#include "scenarios/input/message.h"
#include "scenarios/shipped.h"
#include "sim/pictures/picture_file.h"
#include "tools/files/output_file.h"
#include "tools/lcs/interrupt.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/summary.h"

namespace lcs::tools {
namespace {

/// Waits until a block can be written. A write to a pipe that nobody reads would block forever,
/// even across signals. \return false if a termination signal arrived first.
bool has_room(int descriptor) {
  constexpr int kTick_ms = 1000;
  while (true) {
    pollfd one{descriptor, POLLOUT, 0};
    const bool is_last = is_interrupted();
    const int ready = ::poll(&one, 1, is_last ? 0 : kTick_ms);
    if (ready > 0 || (ready < 0 && errno != EINTR)) return true;  // the write reports the error
    if (is_last) return false;
  }
}

/// \return whether all of it was written.
bool write(std::FILE* file, std::string_view text) {
  constexpr std::size_t kBlock = PIPE_BUF;  // a pipe with room accepts this many bytes at once
  for (; !text.empty(); text.remove_prefix(std::min(kBlock, text.size()))) {
    if (!has_room(::fileno(file))) return false;
    const std::string_view block = text.substr(0, kBlock);
    if (std::fwrite(block.data(), 1, block.size(), file) != block.size()) return false;
  }
  return true;
}

/// Flushes stdout, or discards its buffer after a signal. \return whether it was written.
bool flush_out() {
  if (::__fpending(stdout) == 0 || has_room(STDOUT_FILENO)) return std::fflush(stdout) == 0;
  ::__fpurge(stdout);  // otherwise exit would block on it
  return false;
}

[[noreturn]] void fail_out() {
  if (std::ferror(stdout) == 0) throw Interrupted("interrupted before all was told");
  files::fail_to("write to", "standard output", errno);
}

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kBarPeriod(100);
constexpr int kLines = 4;
constexpr const char* kWipe = "\r\x1b[K";

using Clock = std::chrono::steady_clock;

/// Progress of a run on stderr: a bar on a terminal, otherwise a line at every quarter.
class ConsoleProgress : public app::Progress {
 public:
  /// \param total number of `unit`s to process.
  /// \param quiet prints nothing.
  ConsoleProgress(const std::string& name, int total, bool quiet, std::string unit)
      : name_(input::one_line(name)),
        total_(total),
        unit_(std::move(unit)),
        style_(quiet                     ? Style::none
               : ::isatty(STDERR_FILENO) ? Style::bar
                                         : Style::lines) {}
  /// Erases the bar.
  ~ConsoleProgress() override {
    if (style_ == Style::bar) print_err("{}", kWipe);
  }
  ConsoleProgress(const ConsoleProgress&) = delete;
  ConsoleProgress& operator=(const ConsoleProgress&) = delete;

  void show(int done) override {
    if (style_ == Style::bar) show_bar(done);
    if (style_ == Style::lines) show_line(done);
  }

 private:
  void show_bar(int done) {
    const Clock::time_point now = Clock::now();
    if (now - shown_ < kBarPeriod && done < total_) return;
    shown_ = now;
    const int filled = kBarWidth * done / total_;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    print_err("{}{} [{:#<{}}{:.<{}}] {}/{} {}, {:.0f} s left", kWipe, name_, "", filled, "",
              kBarWidth - filled, done, total_, unit_, seconds / done * (total_ - done));
  }

  void show_line(int done) {
    // Prints a line each time another quarter is complete.
    if (done * kLines / total_ > told_ * kLines / total_) {
      print_err("{}: {}/{} {}\n", name_, done, total_, unit_);
    }
    told_ = done;
  }

  std::string name_;
  int total_;
  std::string unit_;
  int told_ = 0;
  enum class Style { none, bar, lines } style_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_{};
};

constexpr std::chrono::milliseconds kPeriod(200);
constexpr std::size_t kUsualWidth = 80;

std::size_t terminal_width() {
  winsize size = {};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : kUsualWidth;
}

}  // namespace

void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // open() returns the lowest free descriptor, which is this one
    if (::fcntl(descriptor, F_GETFD) < 0) ::open("/dev/null", O_RDWR);
  }
}

void write_out(const std::string& text) {
  if (!write(stdout, text)) fail_out();
}

void write_err(const std::string& text) {
  flush_out();  // keeps the order if stdout and stderr are one file
  const std::lock_guard lock(sim::stderr_mutex());
  write(stderr, text);
}

void tell(std::string_view message) {
  write_err(input::one_line(message) + '\n');
}

std::filesystem::path scenario_file(const std::string& named) {
  const auto shipped = scenario::shipped_scenario(named);
  if (shipped) tell(named + " is " + shipped->string());
  return shipped.value_or(named);
}

void warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) tell("warning: " + line);
}

std::string coloured(const std::string& text, suite::Light light) {
  constexpr std::array<int, 3> kCodes{31, 33, 32};  // red, yellow, green
  const auto is = [](const char* variable, auto&& test) {
    const char* value = std::getenv(variable);
    return value != nullptr && test(std::string_view(value));
  };
  const bool is_plain = ::isatty(STDOUT_FILENO) == 0 ||
                        is("NO_COLOR", [](auto value) { return !value.empty(); }) ||
                        is("TERM", [](auto value) { return value == "dumb"; });
  return is_plain
             ? text
             : fmt::format("\x1b[{}m{}\x1b[0m", kCodes.at(static_cast<std::size_t>(light)), text);
}

void Terminal::check() {
  check_interrupted();
}

void Terminal::note(const std::string& line) {
  if (!quiet_) tools::tell(line);
}

void finish_out() {
  std::cout.flush();
  const bool has_failed = std::ferror(stdout) != 0;  // an earlier write failed
  if (!flush_out() || has_failed) fail_out();
}

std::unique_ptr<app::Progress> Terminal::progress(const std::string& name, int total,
                                                  const std::string& unit) {
  return std::make_unique<ConsoleProgress>(name, total, quiet_, unit);
}

void Terminal::wipe() {
  if (is_shown_) print_err("{}", kWipe);
  is_shown_ = false;
}

void Terminal::finished(const suite::SuiteProgress& progress, const std::string& scenario,
                        const std::vector<std::string>& detectors,
                        std::span<const suite::RunResult* const> runs) {
  if (quiet_) return;
  wipe();
  const suite::RunResult& own = *runs.front();
  // A run alone neither passes nor fails criteria over seeds, nor none.
  const bool is_judged =
      !own.criteria.empty() &&
      std::ranges::all_of(own.criteria, [](const auto& one) { return one.over == "seed"; });
  const bool is_only_done = own.outcome == suite::Outcome::passed && !is_judged;
  std::string figures;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const scoring::Metric& metric = scoring::metric(scoring::kF1);
    const std::optional<double> f1 = suite::figure_of(*runs[i], metric.key);
    if (!f1) continue;
    const std::string by = runs.size() > 1 ? detectors[i] + " " : "";
    const std::string label = figures.empty() ? metric.label + " " : "";
    figures += fmt::format(", {}{}{}", label, by, metric.number(f1));
  }
  tell(fmt::format("[run {}/{}] {} seed {}: {}{}, {:.1f} s", progress.done, progress.total,
                   scenario, own.seed, is_only_done ? "done" : suite::word_of(own.outcome), figures,
                   own.wall_s));
  shown_ = {};
}

void Terminal::show(const suite::SuiteProgress& progress) {
  const Clock::time_point now = Clock::now();
  if (quiet_ || ::isatty(STDERR_FILENO) == 0 || now - shown_ < kPeriod) return;
  shown_ = now;
  wipe();
  std::string line = fmt::format("[run {}/{}]", progress.done, progress.total);
  if (progress.left_s) line += fmt::format(" {:.0f} s left,", *progress.left_s);
  line += fmt::format(" running {}", fmt::join(progress.running, ", "));
  line = input::one_line(line);
  print_err("{}", line.substr(0, terminal_width() - 1));
  std::fflush(stderr);
  is_shown_ = true;
}

}  // namespace lcs::tools
