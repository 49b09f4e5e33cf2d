#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "scenarios/input/message.h"
#include "tools/lcs/suite_end.h"
#include "tools/lcs/terminal.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/summary.h"

namespace lcs::tools {
namespace {

constexpr std::chrono::milliseconds kPeriod(200);
constexpr std::size_t kUsualWidth = 80;

std::size_t terminal_width() {
  winsize size = {};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : kUsualWidth;
}

/// Progress of a suite on stderr: a line per finished run, and on a terminal a status line.
class ConsoleSuiteProgress : public app::SuiteWatch {
 public:
  explicit ConsoleSuiteProgress(bool quiet)
      : quiet_(quiet), is_terminal_(::isatty(STDERR_FILENO) != 0) {}
  /// Erases the status line.
  ~ConsoleSuiteProgress() override { ConsoleSuiteProgress::wipe(); }
  ConsoleSuiteProgress(const ConsoleSuiteProgress&) = delete;
  ConsoleSuiteProgress& operator=(const ConsoleSuiteProgress&) = delete;

  void wipe() override {
    if (is_shown_) print_err("\r\x1b[K");
    is_shown_ = false;
  }

  void finished(const suite::SuiteProgress& progress, const std::string& scenario,
                const std::vector<std::string>& detectors,
                std::span<const suite::RunResult* const> runs) override {
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
                     scenario, own.seed, is_only_done ? "done" : suite::word_of(own.outcome),
                     figures, own.wall_s));
    shown_ = {};
  }

  void show(const suite::SuiteProgress& progress) override {
    const Clock::time_point now = Clock::now();
    if (quiet_ || !is_terminal_ || now - shown_ < kPeriod) return;
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

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool is_terminal_;
  bool is_shown_ = false;
  Clock::time_point shown_{};
};

}  // namespace

std::unique_ptr<app::SuiteWatch> suite_progress(bool quiet) {
  return std::make_unique<ConsoleSuiteProgress>(quiet);
}

}  // namespace lcs::tools
