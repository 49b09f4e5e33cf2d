#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "scenarios/input/message.h"
#include "tools/lcs/terminal.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/summary.h"

namespace lcs::tools {
namespace {

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
