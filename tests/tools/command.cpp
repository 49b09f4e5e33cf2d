#include "tests/tools/command.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace lcs::test {
namespace {

/// Runs in the child up to exec; uses only calls that are safe after fork.
[[noreturn]] void become(const char* const* arguments, const CommandOptions& options,
                         const char* out, const char* err) {
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  if (::dup2(::open(out, flags, 0600), STDOUT_FILENO) < 0) ::_exit(126);
  if (::dup2(::open(err, flags, 0600), STDERR_FILENO) < 0) ::_exit(126);
  if (::chdir(options.folder.c_str()) != 0) ::_exit(126);
  const auto limit = [](__rlimit_resource what, const std::optional<std::size_t>& most) {
    if (!most) return;
    const rlimit both{*most, *most};
    ::setrlimit(what, &both);
  };
  if (options.obeys_permissions) {  // without root the permissions apply anyway
    ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
    ::prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH);
  }
  limit(RLIMIT_FSIZE, options.largest_file);
  limit(RLIMIT_AS, options.most_memory);
  // A sanitized build must not list suppressed leaks on stderr.
  ::setenv("LSAN_OPTIONS", "print_suppressions=0", /*overwrite=*/0);
  ::closefrom(STDERR_FILENO + 1);
  for (const int descriptor : options.closed) ::close(descriptor);
  limit(RLIMIT_NOFILE, options.open_files);
  ::execv(LCS_PROGRAM, const_cast<char* const*>(arguments));
  ::_exit(127);
}

std::string read_all(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

Command::Command(const std::vector<std::string>& arguments, const CommandOptions& options) {
  std::string capture = (std::filesystem::temp_directory_path() / "lcs-command-XXXXXX").string();
  if (::mkdtemp(capture.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  capture_ = capture;

  std::vector<const char*> pointers{LCS_PROGRAM};
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  pointers.push_back(nullptr);
  const std::string err = capture_ / "err";
  const std::string out = options.out.empty() ? capture_ / "out" : options.out;

  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) become(pointers.data(), options, out.c_str(), err.c_str());
}

Command::~Command() {
  wait();
  std::filesystem::remove_all(capture_);
}

void Command::send(int signal) const {
  ::kill(pid_, signal);
}

bool Command::collect(int flags) {
  int status = 0;
  rusage usage{};
  if (status_ || ::wait4(pid_, &status, flags, &usage) != pid_) return status_.has_value();
  status_ = status;
  peak_bytes_ = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
  return true;
}

bool Command::is_running() {
  return !collect(WNOHANG);
}

CommandResult Command::wait() {
  if (!collect(0)) status_ = 0;
  return {.exit_code = WIFEXITED(*status_) ? WEXITSTATUS(*status_) : 128 + WTERMSIG(*status_),
          .out = read_all(capture_ / "out"),
          .err = read_all(capture_ / "err"),
          .peak_bytes = peak_bytes_};
}

CommandResult run_lcs(const std::vector<std::string>& arguments, const CommandOptions& options) {
  return Command(arguments, options).wait();
}

}  // namespace lcs::test
