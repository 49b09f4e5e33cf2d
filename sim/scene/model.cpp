#include "sim/scene/model.h"

#include <Eigen/Core>
#include <array>
#include <mutex>
#include <tuple>
#include <utility>

#include "sim/scene/limits.h"
#include "sim/scene/trial.h"

namespace lcs::sim {
namespace {

thread_local std::string first_warning;

void on_error(const char* message) {
  throw MujocoError(message);
}

void on_warning(const char* message) {
  if (first_warning.empty()) first_warning = message;
}

Pose pose(const mjtNum* position, const mjtNum* rotation) {
  return {Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation),
          Eigen::Map<const Eigen::Vector3d>(position)};
}

using ModelAndData =
    std::pair<std::unique_ptr<mjModel, ModelDeleter>, std::unique_ptr<mjData, DataDeleter>>;

ModelAndData load(const std::string& mjcf) {
  const auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  const auto release = [](mjVFS* v) { mj_deleteVFS(v); };
  const std::unique_ptr<mjVFS, decltype(release)> guard(vfs.get(), release);
  constexpr const char* kName = "scene.xml";
  if (mj_addBufferVFS(vfs.get(), kName, mjcf.data(), static_cast<int>(mjcf.size())) != 0) {
    throw MujocoError("could not allocate the document");
  }

  ModelAndData loaded;
  auto& [model, data] = loaded;
  std::array<char, 2000> message{};
  model.reset(mj_loadXML(kName, vfs.get(), message.data(), static_cast<int>(message.size())));
  const std::string warning = take_warning();
  if (message[0] != '\0') throw MujocoError(message.data());
  if (!model) throw MujocoError("no reason is given");
  if (!warning.empty()) throw MujocoError(warning);
  check_compiled(*model);
  data.reset(mj_makeData(model.get()));
  if (!data) throw MujocoError("could not allocate the state of the scene");
  return loaded;
}

}  // namespace

void install_mujoco_handlers() {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
}

std::string take_warning() {
  return std::exchange(first_warning, {});
}

Model::Model(const std::string& mjcf) {
  install_mujoco_handlers();
  // MuJoCo holds its own lock during a load: no other thread may fork then
  static std::mutex loading;
  const std::lock_guard lock(loading);
  const Trial trial = try_in_child([&] { load(mjcf); });
  if (!trial.refused.empty()) throw MujocoError(trial.refused);
  if (trial.crash.starts_with("signal")) {
    throw MujocoCrash("MuJoCo crashes on this scene (" + trial.crash +
                      "); take out what was changed last; meshes, skins and textures are the first "
                      "to look at");
  }
  if (!trial.fine) {
    const std::string what =
        trial.crash == "memory" ? "too much memory" : "more than " + trial.crash;
    throw MujocoCrash(
        "MuJoCo needs " + what + " to load this scene; make it smaller (sizes in " +
        "<size>, composites, textures, meshes), or raise ulimit -v where that is set");
  }
  std::tie(model_, data_) = load(mjcf);
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
