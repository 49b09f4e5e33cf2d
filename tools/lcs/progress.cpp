#include <unistd.h>

#include <chrono>
#include <utility>

#include "scenarios/input/message.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kBarPeriod(100);
constexpr int kLines = 4;
constexpr const char* kWipe = "\r\x1b[K";

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

  using Clock = std::chrono::steady_clock;
  std::string name_;
  int total_;
  std::string unit_;
  int told_ = 0;
  enum class Style { none, bar, lines } style_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_{};
};

}  // namespace

std::unique_ptr<app::Progress> Terminal::progress(const std::string& name, int total,
                                                  const std::string& unit) {
  return std::make_unique<ConsoleProgress>(name, total, quiet_, unit);
}

}  // namespace lcs::tools
