#include "sim/scene/model.h"

#include <Eigen/Core>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "sim/scene/limits.h"

namespace lcs::sim {
namespace {

thread_local std::string first_warning;

/// \name Where an error of MuJoCo in this thread jumps to, null outside of `call_mujoco`, and its
/// message. They are not local to the function, because a jump may lose changes of local variables.
///@{
thread_local std::jmp_buf* call_in_progress = nullptr;
thread_local std::array<char, 1024> error_message{};
///@}

void on_error(const char* message) {
  if (call_in_progress != nullptr) {
    std::snprintf(error_message.data(), error_message.size(), "%s", message);
    std::longjmp(*call_in_progress, 1);  // NOLINT(cert-err52-cpp): over C frames alone
  }
  constexpr int kError = 2;  // as tools/lcs/command_line.h
  std::fprintf(stderr, "error of MuJoCo: %s; please report it with the scenario\n", message);
  std::_Exit(kError);
}

void on_warning(const char* message) {
  if (first_warning.empty()) first_warning = message;
}

Pose pose(const mjtNum* position, const mjtNum* rotation) {
  return {Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation),
          Eigen::Map<const Eigen::Vector3d>(position)};
}

}  // namespace

void install_mujoco_handlers() {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
}

void call_mujoco(void (*calls)(const void*), const void* context) {
  std::jmp_buf here;
  std::jmp_buf* const outer = call_in_progress;
  call_in_progress = &here;
  const bool has_failed = setjmp(here) != 0;  // NOLINT(cert-err52-cpp)
  if (!has_failed) calls(context);
  call_in_progress = outer;
  if (has_failed) throw MujocoError(error_message.data());
}

std::string take_warning() {
  return std::exchange(first_warning, {});
}

Model::Model(mjSpec& spec) {
  install_mujoco_handlers();
  model_.reset(call_mujoco([&] { return mj_compile(&spec, nullptr); }));
  if (!model_) throw MujocoError(mjs_getError(&spec));
  check_compiled(*model_);
  data_.reset(call_mujoco([&] { return mj_makeData(model_.get()); }));
  if (!data_) throw MujocoError("could not allocate the state of the scene");
}

bool Model::has(mjtObj type, const std::string& name) const {
  return mj_name2id(model_.get(), type, name.c_str()) >= 0;
}

int Model::id(mjtObj type, const std::string& name) const {
  const int id = mj_name2id(model_.get(), type, name.c_str());
  if (id < 0) throw MujocoError(std::string(mju_type2Str(type)) + " '" + name + "' is missing");
  return id;
}

std::string_view Model::name(mjtObj type, int id) const {
  const char* name = mj_id2name(model_.get(), type, id);
  return name ? std::string_view(name) : std::string_view();
}

Pose Model::body_pose(int body) const {
  return pose(data_->xpos + 3 * body, data_->xmat + 9 * body);
}

Pose Model::geom_pose(int geom) const {
  return pose(data_->geom_xpos + 3 * geom, data_->geom_xmat + 9 * geom);
}

Pose Model::site_pose(int site) const {
  return pose(data_->site_xpos + 3 * site, data_->site_xmat + 9 * site);
}

Pose Model::camera_pose(int camera) const {
  Pose T = pose(data_->cam_xpos + 3 * camera, data_->cam_xmat + 9 * camera);
  // MuJoCo's camera looks along its -z, with y up
  T.R.col(1) = -T.R.col(1);
  T.R.col(2) = -T.R.col(2);
  return T;
}

}  // namespace lcs::sim
