#include "tools/lcs/progress.h"

#include <unistd.h>

#include <utility>

#include "scenarios/input/message.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kBarPeriod(100);
constexpr int kLines = 4;
constexpr const char* kWipe = "\r\x1b[K";

}  // namespace

ConsoleProgress::ConsoleProgress(std::string name, int total, bool quiet, std::string unit)
    : name_(input::one_line(name)),
      total_(total),
      unit_(std::move(unit)),
      style_(quiet                     ? Style::none
             : ::isatty(STDERR_FILENO) ? Style::bar
                                       : Style::lines) {}

ConsoleProgress::~ConsoleProgress() {
  if (style_ == Style::bar) print_err("{}", kWipe);
}

void ConsoleProgress::show(int done) {
  if (style_ == Style::bar) show_bar(done);
  if (style_ == Style::lines) show_line(done);
}

void ConsoleProgress::show_bar(int done) {
  const Clock::time_point now = Clock::now();
  if (now - shown_ < kBarPeriod && done < total_) return;
  shown_ = now;
  const int filled = kBarWidth * done / total_;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  print_err("{}{} [{:#<{}}{:.<{}}] {}/{} {}, {:.0f} s left", kWipe, name_, "", filled, "",
            kBarWidth - filled, done, total_, unit_, seconds / done * (total_ - done));
}

void ConsoleProgress::show_line(int done) {
  // Prints a line each time another quarter is complete.
  if (done * kLines / total_ > told_ * kLines / total_) {
    print_err("{}: {}/{} {}\n", name_, done, total_, unit_);
  }
  told_ = done;
}

}  // namespace lcs::tools
