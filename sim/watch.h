/// \file
/// Watches a world while it runs, without changing it, and counts what should not happen: bodies
/// that pass through each other, fall, or tip over.
///
/// The holonomic rover and the actors have no contacts, so overlaps are looked for in the geoms
/// that are drawn. What stands on a floor (a plane that faces up, a height field) may touch it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/model.h"
#include "sim/overlap.h"
#include "sim/warnings.h"

namespace lcs::sim {

/// Whether the camera can see it.
bool is_drawn(const mjModel& m, int geom);
/// A plane that faces up, or a height field.
bool is_floor(const Model& model, int geom);

class Watch {
 public:
  enum class Kind { rover, actor, object, setting };

  /// One of the world's objects.
  struct Named {
    std::string name;
    int body = 0;
    bool is_actor = false;
  };

  /// \param object_of_geom as `World::object_of_geom`; `objects[i]` is object i + 1.
  Watch(const Model& model, int rover_body, const std::vector<Named>& objects,
        const std::vector<int>& object_of_geom);

  /// Two that overlap.
  struct Meeting {
    int traveller = 0;  ///< the rover (0), or an actor by the object that it is
    int other = 0;      ///< among all that can be met
    Kind kind_b = Kind::setting;
    std::string a, b;   ///< as in "actor 'car'"
    std::string where;  ///< as in "(1.20, -0.40) m"
    double depth_m = 0;
  };
  /// All that overlap now.
  std::vector<Meeting> meetings(const Model& model);
  /// From now on this overlap is expected: no warning is given of it.
  void pass_over(const Meeting& meeting);

  /// To be called after every step; checks all overlaps again when something has moved by a few
  /// centimetres.
  void look(const Model& model, std::int64_t t_ns);

  const Warnings& warnings() const { return warnings_; }

 private:
  /// What overlaps are counted of: the rover, an object, a geom of the setting.
  struct Solid {
    Kind kind = Kind::setting;
    std::string name;
    int body = 0;
    std::vector<int> geoms = {};  ///< those that are drawn
    Eigen::Vector3d centre_B = Eigen::Vector3d::Zero();
    double radius_m = 0;  ///< of a sphere round all of it
    double foot_m = 0;    ///< its lowest point at the start, over its body's origin
    bool moves = false;   ///< by itself, or by the physics
    bool is_low = false;  ///< under the ground, and told
  };
  using Pair = std::pair<std::size_t, std::size_t>;

  void add_solid(const Model& model, Solid solid);
  bool is_step(const Model& model, const Solid& who, const Solid& what, int geom);
  Overlap::Place meeting(const Model& model, const Solid& who, const Solid& what);
  template <typename Found>
  void find_meetings(const Model& model, const Found& found);
  bool has_moved(const Model& model);
  void note_contacts(const Model& model, std::int64_t t_ns);
  void note_meeting(const Pair& pair, const Eigen::Vector3d& point, std::int64_t t_ns);
  void note_falls(const Model& model, std::int64_t t_ns);
  void note_attitude(const Model& model, std::int64_t t_ns);
  double floor_m(const Model& model, const Eigen::Vector3d& at) const;

  std::vector<Solid> solids_;  ///< the rover first
  std::vector<int> solid_of_geom_;
  std::vector<int> floors_;  ///< planes that face up, and height fields
  double lowest_m_ = 0;      ///< of the setting
  double start_m_ = 0;       ///< height of the rover at the start
  Overlap overlap_;
  std::set<Pair> met_;
  std::vector<Pose> last_;  ///< of the solids that move, at the last close look
  bool is_tipped_ = false;
  Warnings warnings_;
};

}  // namespace lcs::sim
