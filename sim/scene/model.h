/// \file
/// A compiled MuJoCo model and its state under RAII, with MuJoCo's errors as exceptions.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include "sim/base/pose.h"
#include "sim/scene/mujoco.h"

namespace lcs::sim {

/// An error that MuJoCo reports for a document or for a call.
class MujocoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// MuJoCo's message in the words of this program: in one line, with a remedy: "problem; remedy".
/// \param more appended to the problem, for example " (body 'ball')".
std::string in_one_line(const std::string& said, const std::string& more = "");

/// Makes MuJoCo report its errors to `call_mujoco`, and keep its warnings for `take_warning`.
/// Process-wide. All code here that uses MuJoCo calls it.
void install_mujoco_handlers();

/// `call_mujoco` for a function with a context.
void call_mujoco(void (*calls)(const void*), const void* context);

/// Makes calls of MuJoCo that may fail, as in `call_mujoco([&] { mj_step(&m, &d); })`.
///
/// MuJoCo's error handler must not return, and an exception must not pass MuJoCo's C frames: the
/// handler jumps back to this function (longjmp), which throws from its own C++ frame. MuJoCo's
/// Python module does the same; an error outside of such calls ends the process with its message.
/// \param calls of MuJoCo alone: the jump destroys no object that `calls` has made.
/// \return its result. \throws MujocoError with MuJoCo's message.
template <class Calls>
auto call_mujoco(const Calls& calls) {
  if constexpr (std::is_void_v<decltype(calls())>) {
    call_mujoco([](const void* context) { (*static_cast<const Calls*>(context))(); }, &calls);
  } else {
    decltype(calls()) result{};
    call_mujoco([&] { result = calls(); });
    return result;
  }
}

/// The first warning that MuJoCo gave in this thread since the last call; empty without a warning.
std::string take_warning();

struct ModelDeleter {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
};
struct DataDeleter {
  void operator()(mjData* d) const { mj_deleteData(d); }
};

/// Model and data, always together. Movable; moving keeps the addresses of `m()` and `d()`.
class Model {
 public:
  /// \throws MujocoError with MuJoCo's message; warnings remain in `spec` and for `take_warning`.
  explicit Model(mjSpec& spec);

  mjModel& m() { return *model_; }
  const mjModel& m() const { return *model_; }
  mjData& d() { return *data_; }
  const mjData& d() const { return *data_; }

  bool has(mjtObj type, const std::string& name) const;
  /// Index of a named element. \throws MujocoError if it is missing.
  int id(mjtObj type, const std::string& name) const;
  /// Name of an element; empty for an unnamed element.
  std::string_view name(mjtObj type, int id) const;

  /// \name Poses in W, as of the last forward pass.
  ///@{
  Pose body_pose(int body) const;
  Pose geom_pose(int geom) const;
  Pose site_pose(int site) const;
  Pose camera_pose(int camera) const;  ///< in the convention of `Pinhole`: z forward, y down
                                       ///@}

 private:
  std::unique_ptr<mjModel, ModelDeleter> model_;
  std::unique_ptr<mjData, DataDeleter> data_;
};

}  // namespace lcs::sim
