/// \file
/// MJCF files as MuJoCo's editable models (`mjSpec`), whose elements still know the file and line
/// that they come from.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/pose.h"
#include "sim/scene/mujoco.h"
#include "sim/scene/xml.h"

namespace lcs::sim {

struct SpecDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
using Spec = std::unique_ptr<mjSpec, SpecDeleter>;

/// Reads files so that each of their lines has a number of its own. MuJoCo keeps that number with
/// an element, also when the element is attached to another model.
class SpecReader {
 public:
  using Edit = std::function<void(xml::Element& root, bool is_model)>;

  /// What the file is read for. Fragments lose their settings of the whole simulation.
  enum class Part { scene, fragment };

  /// \param where cited in the error if the file itself cannot be opened.
  /// \param edit changes the documents of the file and of its `<model>`s before MuJoCo reads them.
  /// \throws input::Error with the user's file and line.
  Spec read(const std::filesystem::path& file, const input::Source& where, Part part,
            const Edit& edit = {});

  /// Source of an element of any model that this reader has read, and of those that they were
  /// attached to; the first file for an element that the program made, and for nullptr.
  input::Source source(const mjsElement* element) const;

  /// \throws input::Error at an element; "TAG" in the text is replaced by its tag.
  [[noreturn]] void refuse(const mjsElement* element, std::string what) const;

  /// Source of the first element of that tag, "<option>"; the first file without one.
  input::Source source_of_tag(std::string_view tag) const;

  /// MuJoCo's message as an error that names the user's file, line and element.
  input::Error refusal(const std::string& said, const mjSpec* spec,
                       std::string_view verb = "refuses") const;

  /// Keeps what MuJoCo has warned of, in this thread and in `spec`, once each.
  void note_warnings(const mjSpec* spec);
  /// Each with file, line and element.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  struct Origin {
    input::Source source;
    std::string tag;           ///< `<geom name="wall">`
    bool has_endless = false;  ///< it may have a number that is not finite
  };
  std::string numbered(xml::Element& root);
  void add_models(xml::Element& root, Part part, const Edit& edit, mjVFS& vfs, int depth);
  const Origin* at(int line) const;
  const Origin* origin(const mjsElement* element) const;
  const Origin* origin_in(const std::string& said, const mjSpec* spec) const;

  std::filesystem::path first_file_;
  std::map<int, Origin> origins_;  ///< by line
  int lines_ = 0;                  ///< number of the last line of all files
  int models_ = 0;                 ///< number of files that are given to MuJoCo as <model>
  std::vector<std::string> warnings_;
};

/// Whether a geom of this type rolls; its radius is the first of its sizes.
inline bool is_round(int type) {
  return type == mjGEOM_SPHERE || type == mjGEOM_CYLINDER || type == mjGEOM_ELLIPSOID;
}

/// The name of an element; "" without one.
std::string_view name_of(const mjsElement* element);

/// The element of that type and name; nullptr if missing.
mjsElement* find(const mjSpec& spec, mjtObj type, std::string_view name);

/// Calls `visit(element)` for the elements of a type: all of a model, or those in a body, and in
/// its descendants if `deep`. `visit` may delete the element.
///@{
void for_each(const mjSpec& spec, mjtObj type, const auto& visit) {
  for (mjsElement *e = mjs_firstElement(&spec, type), *next = nullptr; e; e = next) {
    next = mjs_nextElement(&spec, e);
    visit(e);
  }
}
void for_each_in(const mjsBody& body, mjtObj type, bool deep, const auto& visit) {
  for (mjsElement *e = mjs_firstChild(&body, type, deep), *next = nullptr; e; e = next) {
    next = mjs_nextChild(&body, e, deep);
    visit(e);
  }
}
///@}

/// Removes an element, and the actuators, sensors, constraints and tendons that refer to it.
void remove(mjSpec& spec, mjsElement* element);

/// Pose of a body, geom or site in the body that has it, through the frames about it.
Pose pose_in_body(const mjsElement* element);

/// Takes frames and other notations away: the element has this pose in its body.
/// \param scale of its shape along the columns of `axes`, in the body.
void set_pose_in_body(mjsElement* element, const Pose& pose,
                      const Eigen::Vector3d& scale = Eigen::Vector3d::Ones(),
                      const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

}  // namespace lcs::sim
