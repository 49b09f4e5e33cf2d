/// \file
/// Monitors a running world, without changing it, and counts physical faults: bodies that pass
/// through each other, fall, or tip over.
///
/// The holonomic rover and the actors have no contacts, so overlaps are between visible geoms.
/// Bodies may touch a floor (a plane that faces up, or a height field).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/scene/model.h"
#include "sim/world/rover.h"
#include "sim/world/warnings.h"

namespace lcs::sim {

/// Penetration depth of two geoms of a model, with or without contacts.
class Overlap {
 public:
  /// An overlap at the last forward pass.
  struct Place {
    double depth_m = 0;  ///< least translation that separates the two geoms; 0 if they are apart
    Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< a point in both geoms, in W
  };

  /// The overlap of two geoms; neither may be a plane or a height field. A mesh is its surface and
  /// the enclosed volume, not its hull: the space under a table is free. Depths of round geoms and
  /// meshes may be too large by a few per cent, never too small. Separate geoms have depth 0.
  /// \param least_depth_m smaller depths count as separate.
  Place of(const Model& model, int geom_a, int geom_b, double least_depth_m);

  /// The overlap of a geom with a bounded plane: the geom extends that deep to both of its sides.
  Place across(const Model& model, int plane, int geom, double least_depth_m);

  /// Points whose convex hull is the geom, in the geom's frame; computed once.
  const Eigen::Matrix3Xd& hull(const Model& model, int geom);

 private:
  double width_m(const Model& model, int geom_a, int geom_b, const Eigen::Vector3d& direction_W);

  std::map<int, Eigen::Matrix3Xd> hulls_;
};

/// A plane that faces up, or a height field.
bool is_floor(const Model& model, int geom);

/// The pairs of geoms of which a part of the surfaces, as faces of a wall and of a door in it, is
/// in one place, to 0.1 mm, as a camera at `eye` sees: a picture shows now one and now the other,
/// so that labels and textures change from frame to frame. It is found by rays onto the six sides
/// of each geom; a common part below a quarter of a side of both is passed over.
/// \param is_drawn of each geom; others have no surface.
std::vector<std::pair<int, int>> coplanar_geoms(const Model& model,
                                                const std::vector<char>& is_drawn,
                                                const Eigen::Vector3d& eye);

class Watch {
 public:
  enum class Kind { rover, actor, object, setting };

  /// A unit of the overlap check: the rover, an object, or a geom of the setting.
  struct Solid {
    Kind kind = Kind::setting;
    std::string name;
    int body = 0;
    std::optional<Eigen::Vector3d> size_m = {};  ///< that its file or the scenario states
    bool moves = false;                          ///< as an actor or by the physics
    /// \name Filled in by the constructor.
    ///@{
    std::vector<int> geoms = {};  ///< visible geoms
    Eigen::Vector3d centre_B = Eigen::Vector3d::Zero();
    double radius_m = 0;  ///< of a bounding sphere around `centre_B`
    double foot_m = 0;    ///< actors: lowest point at the start, over the body's origin
    bool is_low = false;  ///< in or below the ground, with a warning given
    ///@}
  };

  /// \param object_of_geom as `World::object_of_geom`; `objects[i]` is object i + 1.
  /// \param is_drawn of each geom: whether the camera can see it.
  Watch(const Model& model, int rover_body, std::vector<Solid> objects,
        const std::vector<int>& object_of_geom, const std::vector<char>& is_drawn);

  /// An overlap of two solids.
  struct Meeting {
    int traveller = 0;  ///< the rover (0), or an actor's object id
    int other = 0;      ///< index of the other solid
    Kind kind_b = Kind::setting;
    std::string a, b;   ///< for example "actor 'car'"
    std::string where;  ///< for example "(1.20, -0.40) m"
    double depth_m = 0;
  };
  /// All present overlaps.
  std::vector<Meeting> meetings(const Model& model);
  /// Suppresses warnings of this overlap from now on.
  void pass_over(const Meeting& meeting);

  /// Call it after every step. It recomputes all overlaps once anything has moved by a few
  /// centimetres.
  /// \param asked the commanded velocity of the step; absent for a camera without a vehicle, which
  ///   may have any attitude. \param t_ns at the start of the step.
  void look(const Model& model, std::int64_t t_ns, const std::optional<PlanarVelocity>& asked);

  Warnings& warnings() { return warnings_; }
  const Warnings& warnings() const { return warnings_; }

 private:
  /// The path of the rover over a second: as commanded, and as driven, in B.
  struct Drive {
    std::int64_t from_ns = 0;
    PlanarVelocity asked, done;  ///< integrals: metres and radians
  };
  using Pair = std::pair<std::size_t, std::size_t>;

  void add_solid(const Model& model, Solid solid);
  bool is_step(const Model& model, const Solid& who, const Solid& what, int geom);
  Overlap::Place meeting(const Model& model, const Solid& who, const Solid& what);
  void find_meetings(const Model& model, const auto& found);
  bool has_moved(const Model& model);
  void note_contacts(const Model& model, std::int64_t t_ns);
  void note_meeting(const Pair& pair, const Eigen::Vector3d& point, std::int64_t t_ns);
  void note_falls(const Model& model, std::int64_t t_ns);
  void note_attitude(const Model& model, std::int64_t t_ns);
  void note_drive(const Model& model, std::int64_t t_ns, const PlanarVelocity& asked);
  void check_size(const Model& model, const Solid& solid, const Eigen::Vector3d& stated_m);
  double floor_m(const Model& model, const Eigen::Vector3d& at) const;

  std::vector<Solid> solids_;  ///< the rover first
  std::vector<int> solid_of_geom_;
  std::vector<int> floors_;  ///< geoms that are floors, see `is_floor`
  bool has_field_ = false;   ///< one of them is a height field
  double lowest_m_ = 0;      ///< lowest height of the setting
  double start_m_ = 0;       ///< height of the rover at the start
  Overlap overlap_;
  std::set<Pair> met_;
  std::vector<Pose> last_;  ///< of the moving solids, at the last overlap check
  bool is_tipped_ = false;
  Drive drive_;
  Pose last_T_WB_;            ///< of the rover, at the last step
  std::int64_t last_ns_ = 0;  ///< its time
  Warnings warnings_;
};

}  // namespace lcs::sim
