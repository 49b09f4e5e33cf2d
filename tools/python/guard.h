/// \file
/// Conditions under which the bench works in a Python process.
#pragma once

#include <pybind11/pybind11.h>

namespace lcs::python {

/// Whether this process was forked after a simulation. Software GL would then wait forever for its
/// threads, which a fork does not copy.
bool is_fork();

/// \throws std::runtime_error in such a process.
void require_no_fork();

/// Restricts OpenCV to one thread while any instance exists, as in the program. Restores the number
/// of threads afterwards for a `cv2` in the same process.
class [[nodiscard]] OneThread {
 public:
  OneThread();
  ~OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
};

/// Runs Python's signal handlers, in its main thread. Needs no GIL.
/// \throws py::error_already_set if one raises, as Ctrl-C does.
void check_signals();

}  // namespace lcs::python
