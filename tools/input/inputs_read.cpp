#include "tools/input/inputs_read.h"

#include <mutex>
#include <set>

namespace lcs::input {
namespace {

std::mutex mutex;

std::set<std::filesystem::path>& noted() {
  static std::set<std::filesystem::path> paths;
  return paths;
}

}  // namespace

void note_input(const std::filesystem::path& path) {
  std::error_code error;  // if the working folder is gone, record the path as given
  std::filesystem::path absolute = std::filesystem::absolute(path, error);
  const std::lock_guard lock(mutex);
  noted().insert(error ? path : std::move(absolute));
}

std::vector<std::filesystem::path> inputs_read() {
  const std::lock_guard lock(mutex);
  return {noted().begin(), noted().end()};
}

void forget_inputs() {
  const std::lock_guard lock(mutex);
  noted().clear();
}

}  // namespace lcs::input
