/// \file
/// Runs a command, counts the system calls of all its processes that touch one folder, and makes
/// one of them fail, or kills after it.
///
/// `strace --inject` is not used, because it counts the calls of each process and each thread for
/// themselves: "the seventh write" fails once in each process that writes seven times. Here a call
/// has a name that is the same in each run: its kind, its path, and which one of this kind and path
/// it is. Process numbers in paths (`made.partial-4711`) count as equal.
///
/// The actions: EIO and ENOSPC let the call fail; full lets a write take half of its bytes, and
/// from then on fails all that takes room; kill, kill-first and kill-all send SIGKILL after the
/// call to the process that made it, to the first process, to all of them; kill-torn as kill, after
/// half of a write.
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/reg.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

[[noreturn]] void die(const std::string& what) {
  std::fprintf(stderr, "call_tracer: %s: %s\n", what.c_str(), std::strerror(errno));
  std::_Exit(125);
}

/// The arguments of a call that name a file. -1: the call has none.
struct Kind {
  const char* name;
  int folder = -1, path = -1;              // openat(FOLDER, PATH)
  int other_folder = -1, other_path = -1;  // renameat(..., OTHER_FOLDER, OTHER_PATH)
  int file = -1;                           // write(FILE)
  int flags = -1;                          // open(..., FLAGS)
  int size = -1;                           // write(..., SIZE)
  bool takes_room = false;                 // fails on a full disk
};

const std::map<long, Kind>& kinds() {
  static const std::map<long, Kind> all{
      {SYS_open, {.name = "open", .path = 0, .flags = 1}},
      {SYS_openat, {.name = "open", .folder = 0, .path = 1, .flags = 2}},
      {SYS_creat, {.name = "create", .path = 0, .takes_room = true}},
      {SYS_write, {.name = "write", .file = 0, .size = 2, .takes_room = true}},
      {SYS_writev, {.name = "write", .file = 0, .takes_room = true}},
      {SYS_pwrite64, {.name = "write", .file = 0, .size = 2, .takes_room = true}},
      {SYS_pwritev, {.name = "write", .file = 0, .takes_room = true}},
      {SYS_sendfile, {.name = "sendfile", .file = 0, .size = 3, .takes_room = true}},
      {SYS_copy_file_range, {.name = "copy_file_range", .file = 2, .size = 4, .takes_room = true}},
      {SYS_fallocate, {.name = "fallocate", .file = 0, .takes_room = true}},
      {SYS_ftruncate, {.name = "ftruncate", .file = 0}},
      {SYS_truncate, {.name = "truncate", .path = 0}},
      {SYS_rename, {.name = "rename", .path = 0, .other_path = 1}},
      {SYS_renameat,
       {.name = "rename", .folder = 0, .path = 1, .other_folder = 2, .other_path = 3}},
      {SYS_renameat2,
       {.name = "rename", .folder = 0, .path = 1, .other_folder = 2, .other_path = 3, .flags = 4}},
      {SYS_link, {.name = "link", .path = 0, .other_path = 1}},
      {SYS_linkat, {.name = "link", .folder = 0, .path = 1, .other_folder = 2, .other_path = 3}},
      {SYS_symlink, {.name = "symlink", .path = 1}},
      {SYS_symlinkat, {.name = "symlink", .folder = 1, .path = 2}},
      {SYS_unlink, {.name = "unlink", .path = 0}},
      {SYS_unlinkat, {.name = "unlink", .folder = 0, .path = 1}},
      {SYS_rmdir, {.name = "rmdir", .path = 0}},
      {SYS_mkdir, {.name = "mkdir", .path = 0, .takes_room = true}},
      {SYS_mkdirat, {.name = "mkdir", .folder = 0, .path = 1, .takes_room = true}},
      {SYS_fsync, {.name = "fsync", .file = 0}},
      {SYS_fdatasync, {.name = "fsync", .file = 0}},
      {SYS_syncfs, {.name = "fsync", .file = 0}},
      {SYS_close, {.name = "close", .file = 0}},
  };
  return all;
}

std::string proc(pid_t task, const std::string& rest) {
  return "/proc/" + std::to_string(task) + "/" + rest;
}

std::string link_target(const std::string& link) {
  std::error_code error;
  return fs::read_symlink(link, error).string();
}

std::string string_at(pid_t task, unsigned long address) {
  std::string text;
  std::array<char, 256> block;
  while (text.size() < PATH_MAX) {
    // Not over the end of a page, behind which there may be none.
    const std::size_t size = std::min(block.size(), 4096 - (address + text.size()) % 4096);
    const iovec to{block.data(), size}, from{reinterpret_cast<void*>(address + text.size()), size};
    const ssize_t got = ::process_vm_readv(task, &to, 1, &from, 1, 0);
    if (got <= 0) break;
    const std::size_t length = ::strnlen(block.data(), static_cast<std::size_t>(got));
    text.append(block.data(), length);
    if (length < static_cast<std::size_t>(got)) break;
  }
  return text;
}

std::string path_at(pid_t task, const std::uint64_t* args, int folder, int path) {
  fs::path named = string_at(task, args[path]);
  if (named.is_relative()) {
    const int file = folder < 0 ? AT_FDCWD : static_cast<int>(args[folder]);
    named = fs::path(link_target(file == AT_FDCWD ? proc(task, "cwd")
                                                  : proc(task, "fd/" + std::to_string(file)))) /
            named;
  }
  return named.lexically_normal().string();
}

/// The flags with which a descriptor was opened.
int flags_of(pid_t task, int file) {
  std::FILE* info = std::fopen(proc(task, "fdinfo/" + std::to_string(file)).c_str(), "r");
  unsigned flags = 0;
  if (info && std::fscanf(info, "pos: %*d flags: %o", &flags) != 1) flags = 0;
  if (info) std::fclose(info);
  return static_cast<int>(flags);
}

bool is_to_write(int flags) {
  return (flags & O_ACCMODE) != O_RDONLY;
}

class Tracer {
 public:
  std::string folder, list, target;  // the target is "KIND PATH NUMBER"
  std::string action;                // EIO, ENOSPC, see above

  int run(char** command) {
    out_ = std::fopen(list.c_str(), "we");
    if (!out_) die(list);
    start(command);
    int status = 0, result = 0;
    for (pid_t task; (task = ::waitpid(-1, &status, __WALL)) > 0 || errno == EINTR;) {
      if (task <= 0) continue;
      if (WIFEXITED(status) || WIFSIGNALED(status)) {
        tasks_.erase(task);
        if (task == first_) {
          result = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        }
      } else {
        stopped(task, status);
      }
    }
    std::fclose(out_);
    return result;
  }

 private:
  struct Pending {
    std::string name;
    bool is_target = false;
    int injected = 0;        // the error that the call gets although it was carried out
    int size_register = -1;  // of a call that writes only half of this size
    std::uint64_t size = 0;
  };

  void start(char** command) {
    std::array<int, 2> gate{};
    if (::pipe2(gate.data(), O_CLOEXEC) != 0) die("pipe");
    first_ = ::fork();
    if (first_ < 0) die("fork");
    if (first_ == 0) {
      char byte = 0;
      if (::read(gate[0], &byte, 1) != 1) ::_exit(125);
      stop_at_calls();
      ::execvp(command[0], command);
      die(command[0]);
    }
    if (::ptrace(PTRACE_SEIZE, first_, 0,
                 PTRACE_O_TRACESECCOMP | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK |
                     PTRACE_O_TRACECLONE | PTRACE_O_TRACEEXEC | PTRACE_O_TRACESYSGOOD |
                     PTRACE_O_EXITKILL) != 0) {
      die("ptrace");
    }
    tasks_.insert(first_);
    if (::write(gate[1], "x", 1) != 1) die("pipe");
    ::close(gate[0]);
    ::close(gate[1]);
  }

  /// Lets the kernel stop this process and its children at the calls of the table, and at no
  /// others.
  static void stop_at_calls() {
    std::vector<sock_filter> program{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
    for (const auto& [number, kind] : kinds()) {
      program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<__u32>(number), 0, 1));
      program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE));
    }
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) {
      die("seccomp");
    }
  }

  void stopped(pid_t task, int status) {
    tasks_.insert(task);
    numbers_.insert(std::to_string(task));
    const int signal = WSTOPSIG(status), event = status >> 16;
    if (event == PTRACE_EVENT_SECCOMP) return entered(task);
    if (signal == (SIGTRAP | 0x80)) return left(task);
    if (event == PTRACE_EVENT_STOP && signal != SIGTRAP) {
      ::ptrace(PTRACE_LISTEN, task, 0, 0);
      return;
    }
    go_on(task, event == 0 ? signal : 0);
  }

  static void go_on(pid_t task, int signal = 0) { ::ptrace(PTRACE_CONT, task, 0, signal); }

  /// The registers of a call's arguments.
  static constexpr std::array<int, 6> kRegisters{RDI, RSI, RDX, R10, R8, R9};

  static void poke(pid_t task, int where, std::uint64_t value) {
    ::ptrace(PTRACE_POKEUSER, task, sizeof(long) * static_cast<unsigned>(where), value);
  }

  void entered(pid_t task) {
    __ptrace_syscall_info info{};
    if (::ptrace(PTRACE_GET_SYSCALL_INFO, task, sizeof info, &info) <= 0) return go_on(task);
    const Kind& kind = kinds().at(static_cast<long>(info.seccomp.nr));
    bool takes_room = kind.takes_room;
    const std::optional<std::string> what = name_of(task, kind, info.seccomp.args, takes_room);
    if (!what) return go_on(task);
    const std::string name = *what + ' ' + std::to_string(++seen_[*what]);
    Pending& call = pending_[task];
    call = {.name = name, .is_target = name == target};
    int error = 0;
    if (call.is_target) {
      if (action == "EIO") error = EIO;
      if (action == "ENOSPC") error = ENOSPC;
      is_full_ = action == "full";
      if (action == "full" || action == "kill-torn") {
        const std::uint64_t size = kind.size < 0 ? 0 : info.seccomp.args[kind.size];
        if (size > 1) {
          call.size_register = kRegisters[kind.size];
          call.size = size;
          poke(task, call.size_register, size / 2);
          ::ptrace(PTRACE_SYSCALL, task, 0, 0);
          return;
        }
      }
    }
    if (is_full_ && takes_room) error = ENOSPC;
    if (error != 0 && std::strcmp(kind.name, "close") == 0) {
      call.injected = error;  // Linux closes the file even if it reports an error
    } else if (error != 0) {
      poke(task, ORIG_RAX, ~std::uint64_t{0});
      poke(task, RAX, static_cast<std::uint64_t>(-error));
      note(task, call, -error, true);
      pending_.erase(task);
      return go_on(task);
    }
    ::ptrace(PTRACE_SYSCALL, task, 0, 0);
  }

  void left(pid_t task) {
    const auto found = pending_.find(task);
    if (found == pending_.end()) return go_on(task);
    const Pending call = found->second;
    pending_.erase(found);
    __ptrace_syscall_info info{};
    ::ptrace(PTRACE_GET_SYSCALL_INFO, task, sizeof info, &info);
    if (call.injected != 0) poke(task, RAX, static_cast<std::uint64_t>(-call.injected));
    if (call.size_register >= 0) poke(task, call.size_register, call.size);
    const bool is_kill = call.is_target && action.starts_with("kill");
    note(task, call, call.injected != 0 ? -call.injected : info.exit.rval,
         is_kill || call.injected != 0 || call.size_register >= 0);
    if (is_kill) {
      if (action == "kill" || action == "kill-torn") ::kill(process_of(task), SIGKILL);
      if (action == "kill-first") ::kill(first_, SIGKILL);
      if (action == "kill-all") {
        std::set<pid_t> processes;
        for (const pid_t one : tasks_) processes.insert(process_of(one));
        for (const pid_t one : processes) {
          if (one > 0) ::kill(one, SIGKILL);
        }
      }
    }
    go_on(task);
  }

  static pid_t process_of(pid_t task) {
    std::FILE* file = std::fopen(proc(task, "status").c_str(), "r");
    pid_t process = task;
    for (std::array<char, 256> line{}; file && std::fgets(line.data(), line.size(), file);) {
      if (std::sscanf(line.data(), "Tgid: %d", &process) == 1) break;
    }
    if (file) std::fclose(file);
    return process;
  }

  bool is_inside(const std::string& path) const {
    return path == folder || (path.starts_with(folder) && path[folder.size()] == '/');
  }

  /// A path within the folder, with P in place of the numbers of the command's processes.
  std::string shortened(const std::string& path) const {
    const std::string within = !is_inside(path) ? path
                               : path == folder ? "."
                                                : path.substr(folder.size() + 1);
    static const std::regex number("[0-9]+");
    std::string text;
    std::size_t done = 0;
    for (std::sregex_iterator found(within.begin(), within.end(), number), end; found != end;
         ++found) {
      text += within.substr(done, static_cast<std::size_t>(found->position()) - done);
      text += numbers_.contains(found->str()) ? "P" : found->str();
      done = static_cast<std::size_t>(found->position() + found->length());
    }
    text += within.substr(done);
    if (text.ends_with(" (deleted)")) text.resize(text.size() - 10);
    std::ranges::replace_if(
        text, [](char c) { return c == '\t' || c == '\n'; }, '?');
    return text;
  }

  /// "KIND PATH"; nothing if the call does not touch the folder.
  std::optional<std::string> name_of(pid_t task, const Kind& kind, const std::uint64_t* args,
                                     bool& takes_room) const {
    std::string name = kind.name;
    if (kind.file >= 0) {
      const int file = static_cast<int>(args[kind.file]);
      const std::string path = link_target(proc(task, "fd/" + std::to_string(file)));
      if (!is_inside(path)) return {};
      if (name == "close" && !is_to_write(flags_of(task, file))) name = "close-read";
      return name + '\t' + shortened(path);
    }
    const std::string path = path_at(task, args, kind.folder, kind.path);
    std::string other;
    if (kind.other_path >= 0) other = path_at(task, args, kind.other_folder, kind.other_path);
    if (!is_inside(path) && !is_inside(other)) return {};
    if (name == "open") {
      const int flags = static_cast<int>(args[kind.flags]);
      name = (flags & O_CREAT) != 0 ? "create" : is_to_write(flags) ? "open" : "open-read";
      std::error_code error;
      takes_room = (flags & O_CREAT) != 0 && !fs::exists(path, error);
    } else if (name == "rename" && kind.flags >= 0 && args[kind.flags] == 2) {
      name = "exchange";
    }
    return name + '\t' + shortened(path) + (other.empty() ? "" : " -> " + shortened(other));
  }

  void note(pid_t task, const Pending& call, long long result, bool is_changed) {
    std::fprintf(out_, "%s\t%d\t%lld\t%s\n", call.name.c_str(), task == first_, result,
                 is_changed ? "changed" : "");
    std::fflush(out_);
  }

  pid_t first_ = 0;
  bool is_full_ = false;
  std::FILE* out_ = nullptr;
  std::set<pid_t> tasks_;          // those that run
  std::set<std::string> numbers_;  // of all tasks, also of those that have ended
  std::map<pid_t, Pending> pending_;
  std::map<std::string, int> seen_;
};

}  // namespace

/// call_tracer FOLDER LIST TARGET ACTION COMMAND...; TARGET and ACTION may be empty.
int main(int count, char** words) {
  if (count < 6) {
    std::fputs("call_tracer FOLDER LIST TARGET ACTION COMMAND...\n", stderr);
    return 125;
  }
  Tracer tracer;
  tracer.folder = fs::canonical(words[1]).string();
  tracer.list = words[2];
  tracer.target = words[3];
  tracer.action = words[4];
  return tracer.run(words + 5);
}
