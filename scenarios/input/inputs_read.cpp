#include "scenarios/input/inputs_read.h"

#include <mutex>
#include <utility>

#include "scenarios/input/sha256.h"

namespace lcs::input {
namespace {

std::mutex mutex;

std::map<std::filesystem::path, std::string>& noted() {
  static std::map<std::filesystem::path, std::string> digests;
  return digests;
}

}  // namespace

void note_input(const std::filesystem::path& path) {
  std::error_code error;  // if the working folder is gone, record the path as given
  std::filesystem::path name = std::filesystem::absolute(path, error);
  if (error) name = path;
  const std::filesystem::path real = std::filesystem::weakly_canonical(name, error);
  // Of two names without "..", one may lead through a link.
  const std::filesystem::path normal = name.lexically_normal();
  if (std::filesystem::weakly_canonical(normal, error) == real) name = normal;
  {
    const std::lock_guard lock(mutex);
    if (!noted().try_emplace(name).second) return;
  }
  // Outside of the lock: other threads read their files at the same time.
  std::string digest = sha256_of_file(real).value_or("");
  const std::lock_guard lock(mutex);
  noted()[name] = std::move(digest);
}

std::map<std::filesystem::path, std::string> inputs_read() {
  const std::lock_guard lock(mutex);
  return noted();
}

void forget_inputs() {
  const std::lock_guard lock(mutex);
  noted().clear();
}

}  // namespace lcs::input
