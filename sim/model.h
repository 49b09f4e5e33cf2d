/// \file
/// A compiled MuJoCo model and its state under RAII, with MuJoCo's errors and warnings as
/// exceptions.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "sim/mujoco.h"
#include "sim/pose.h"

namespace lcs::sim {

/// Thrown for what MuJoCo says is wrong with a document, or with how it is used.
class MujocoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown where MuJoCo crashes on a document, or does not end.
class MujocoCrash : public MujocoError {
 public:
  using MujocoError::MujocoError;
};

/// Makes MuJoCo throw `MujocoError` where it would print and wait for a key, and keep its warnings
/// for `take_warning`. Process-wide; called by everything here that uses MuJoCo.
void install_mujoco_handlers();

/// The first warning that MuJoCo gave in this thread since the last call; empty if none.
std::string take_warning();

struct ModelDeleter {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
};
struct DataDeleter {
  void operator()(mjData* d) const { mj_deleteData(d); }
};

/// Model and data, always together. Movable; the addresses of `m()` and `d()` do not change.
class Model {
 public:
  /// Loads the document in a child process first (sim/trial.h), and here only if the child
  /// survives. The child takes 40 ms of processor time for crossing.yaml, as much as the load
  /// itself, out of 1.8 s for `lcs run scenarios/crossing.yaml --quiet --no-video`.
  /// \param mjcf a whole document; files that it names must be absolute paths.
  /// \throws MujocoError with MuJoCo's own message; MujocoCrash in plain words.
  explicit Model(const std::string& mjcf);

  mjModel& m() { return *model_; }
  const mjModel& m() const { return *model_; }
  mjData& d() { return *data_; }
  const mjData& d() const { return *data_; }

  bool has(mjtObj type, const std::string& name) const;
  /// Index of a named element. \throws MujocoError if there is none.
  int id(mjtObj type, const std::string& name) const;
  /// Name of an element, empty where it has none.
  std::string_view name(mjtObj type, int id) const;

  /// \name In W, as of the last forward pass.
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
