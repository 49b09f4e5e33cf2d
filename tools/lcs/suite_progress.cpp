#include "tools/lcs/suite_progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "scenarios/input/message.h"
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

}  // namespace

ConsoleSuiteProgress::ConsoleSuiteProgress(bool quiet)
    : quiet_(quiet), is_terminal_(::isatty(STDERR_FILENO) != 0) {}

ConsoleSuiteProgress::~ConsoleSuiteProgress() {
  wipe();
}

void ConsoleSuiteProgress::wipe() {
  if (is_shown_) print_err("\r\x1b[K");
  is_shown_ = false;
}

void ConsoleSuiteProgress::finished(const suite::SuiteProgress& progress,
                                    const std::string& scenario,
                                    const std::vector<std::string>& detectors,
                                    std::span<const suite::RunResult* const> runs) {
  if (quiet_) return;
  wipe();
  const suite::RunResult& own = *runs.front();
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
                   scenario, own.seed, suite::word_of(own.outcome), figures, own.wall_s));
  shown_ = {};
}

void ConsoleSuiteProgress::show(const suite::SuiteProgress& progress) {
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

}  // namespace lcs::tools
