#include "tools/python/guard.h"

#include <unistd.h>

#include <mutex>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

namespace lcs::python {
namespace {

std::mutex mutex;  // of the count and the number of threads
int count = 0, threads_before = 0;

}  // namespace

bool is_fork() {
  static const pid_t first = ::getpid();
  return ::getpid() != first;
}

void require_no_fork() {
  if (!is_fork()) return;
  throw std::runtime_error(
      "this process was forked from one that has simulated, and software GL does not live on in "
      "it; start processes by multiprocessing's \"spawn\", or simulate in these alone");
}

OneThread::OneThread() {
  const std::lock_guard lock(mutex);
  if (count++ > 0) return;
  threads_before = cv::getNumThreads();
  cv::setNumThreads(0);
}

OneThread::~OneThread() {
  const std::lock_guard lock(mutex);
  if (--count == 0) cv::setNumThreads(threads_before);
}

void check_signals() {
  const pybind11::gil_scoped_acquire interpreter;
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

}  // namespace lcs::python
