/// \file
/// Edges told by groups. With corners 5 to 6 px apart, a chain of three single corners in line is
/// found by chance everywhere; that a corner and its neighbours all find predecessors at one and
/// the same displacement, twice, is not. This rule stands in for xi and alpha of the paper:
///
/// 1. Normal edges are predicted by their own depth, rebels by their own image velocity, and both
///    compete for corners in narrow gates.
/// 2. A corner that no trusted edge explains looks for its static past: a depth at which both of
///    two earlier frames show a corner. Two hits make a normal edge, born with that depth.
/// 3. It also lets its neighbours vote on a common displacement. A motion with more votes than
///    chance gives (`filter/vote_chance.h`) that beats the static explanation of the same corners
///    makes a rebel edge.
/// 4. Rebels bear each other out, or lose trust; their group smooths their velocities
///    (`filter/rebel_groups.h`).
/// 5. A corner among rebels takes their verdict where that is likely (`filter/inheritance.h`), and
///    their motion where its own past confirms it.
#pragma once

#include <utility>
#include <vector>

#include "filter/edge_expert.h"
#include "filter/footing.h"
#include "filter/hit_map.h"
#include "filter/inheritance.h"
#include "filter/nearest_map.h"
#include "filter/rebel_groups.h"
#include "filter/vote_chance.h"

namespace lcs {

class ConstellationEdges : public EdgeExpert {
 public:
  ConstellationEdges(const Intrinsics& camera, const CircleParameters& parameters);

  void predict(Layers& layers, const MotionField& field) override;
  void update(Layers& layers, const Chi& chi, const MotionField& field,
              std::vector<Verdict>& verdicts) override;
  void forget() override { history_.clear(); }

 private:
  /// An earlier frame, in this frame's pixels (rotation removed).
  struct Past {
    std::vector<Vec2> corners;
    std::vector<std::pair<Id, int>> taken;  // edges, by rising id, and the corner that each took
    std::array<Vec2, 4> picture;            // the corners of what it showed
    Eigen::Vector3d displacement_C_m = Eigen::Vector3d::Zero();  // of the camera since then
    double elapsed_s = 0;
  };

  /// An earlier frame to look corners up in.
  struct Lookup {
    explicit Lookup(const Intrinsics& camera) : all(camera.width_px, camera.height_px) {}
    HitMap all;
    std::vector<Vec2> corners;  // those that may be the past of one that is not explained yet
    std::array<Vec2, 4> picture;
    Eigen::Vector3d displacement_C_m;
    double elapsed_s = 0;
  };

  /// What is known of a corner while the frame is being explained.
  struct Candidate {
    bool residual = false;     ///< no trusted edge explains it
    bool unsure = false;       ///< a rebel edge does, but one that is not sure
    int static_hits = 0;       ///< of the last two frames, at the best depth
    int static_votes = 0;      ///< the same, and what hits the picture may not have shown
    double static_ratio = 0;   ///< Z_ref / Z of that depth
    Vec2 step = Vec2::Zero();  ///< displacement that its neighbours voted for, px a frame
    bool voted = false;        ///< for a motion that no static point has
  };

  /// A displacement over a baseline that neighbours agree on.
  struct Motion {
    int votes = 0;
    Vec2 step = Vec2::Zero();  ///< px
  };

  enum class Kind : std::uint8_t { none, normal, rebel };
  /// The edge that a corner belongs to.
  struct Link {
    Kind kind = Kind::none;
    int index = -1;
  };

  void remember(const Layers& layers, const Chi& chi);
  std::size_t stride() const;
  void look_back(const Layers& layers);
  void index(const Past& past, Lookup& lookup);
  void assign(const Layers& layers, const Chi& chi, const MotionField& field);
  void update_normal(Edge& edge, const Vec2& x, const MotionField& field) const;
  void update_rebel(Edge& edge, const Vec2& x, const MotionField& field) const;
  static double off_field(const Vec2& x, const Vec2& before, double least_ratio,
                          const Eigen::Vector3d& displacement_C_m, const MotionField& field);
  bool leaves_path(const Edge& edge, const Vec2& x, const MotionField& field) const;
  void find_residuals(const Layers& layers, const Chi& chi);
  void seek_static_past(const Chi& chi, const MotionField& field);
  bool showed(const Lookup& then, const Vec2& x, const MotionField& field) const;
  int static_hits(const Vec2& x, double depth_ratio, const MotionField& field) const;
  void vote(const Chi& chi, const MotionField& field);
  Reason vote_on(std::size_t corner, const Chi& chi, const MotionField& field);
  int gather_voters(std::size_t corner, const Chi& chi);
  int least_votes(const Vec2& x, int voters) const;
  void place_voters(const Vec2& x);
  int count_votes(const Vec2& x, const Vec2& before, double earlier, int hits, int least) const;
  void try_motions(const Vec2& x, const Vec2& before, int floor, int winning, Motion& best);
  void settle_rebels();
  void make_edges(Layers& layers, const Chi& chi, const MotionField& field);
  Edge make_rebel(const Vec2& x, const Vec2& velocity_pxps, double dt_s);
  const Edge& edge_of(int decided, const Layers& layers) const;
  Surroundings look_around(std::size_t corner, int nearest, double reach_px, const Layers& layers,
                           const Chi& chi);
  void inherit(Layers& layers, const Chi& chi, const MotionField& field);
  void turn_unfounded(Layers& layers, const Chi& chi, const MotionField& field);
  bool confirms(const Vec2& x, const Vec2& step) const;

  CircleParameters parameters_;
  VoteChance chance_;
  RebelGroups groups_;
  Footing footing_;
  std::vector<Past> history_;  // newest first

  // Of the current frame; kept for their memory.
  Discs discs_;                  // of what is looked up next
  Lookup once_, twice_;          // one and two baselines ago
  NearestMap once_free_;         // of once_.corners
  HitMap twice_free_;            // of twice_.corners
  double again_ = 1;             // the second baseline over the first, in time
  bool needs_own_past_ = false;  // of a corner, in the vote
  std::vector<double> earlier_;  // by change of size: the step before over the one over a baseline;
                                 // 0: there was none
  PointGrid once_grid_, decided_grid_;
  std::vector<int> decided_corners_;  // that were called before neighbours were asked
  std::vector<Vec2> decided_locations_, decided_steps_;  // of each: px; of its edge in a frame, px
  std::vector<char> is_normal_;  // corners that established normal edges have
  std::vector<Candidate> candidates_;
  std::vector<Link> links_;   // of each corner
  std::vector<char> called_;  // corners that leave as rebels
  std::vector<Neighbour> near_;
  PointGrid undecided_grid_;
  std::vector<int> undecided_;  // corners that are residual, or of rebels
  std::vector<Vec2> undecided_locations_;
  std::vector<Vec2> voters_;
  std::vector<NearestMap::Steps> arms_;  // of all voters at the first change of size, then the next
  double longest_arm_px_ = 0;
  std::vector<NearestMap::Found> hits_;  // of the arms of a motion
  std::vector<Id> explaining_;           // edges, by rising id
  std::vector<char> is_explained_;       // of a past's corners
  std::vector<Vec2> explained_;          // of a past: not a lookup's corners
};

}  // namespace lcs
