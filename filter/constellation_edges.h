/// \file
/// Edges told by groups. With corners 5 to 6 px apart, a chain of three single corners in line is
/// found by chance everywhere; that a corner and its neighbours all find predecessors at one and
/// the same displacement, twice, is not. This rule stands in for xi and alpha of the paper:
///
/// 1. Normal edges are predicted by their own depth, rebels by their own image velocity, and both
/// compete
///    for corners in narrow gates.
/// 2. A corner that no trusted edge explains looks for its static past: a depth at which both of
/// the last
///    two frames show a corner. Two hits make a normal edge, born with that depth.
/// 3. It also lets its neighbours vote on a common displacement. A motion that beats the static
///    explanation of the same corners makes a rebel edge.
/// 4. Rebels bear each other out, or lose trust; their circle smooths their velocities.
/// 5. A corner among rebels takes their verdict, and their motion where its own past confirms it.
#pragma once

#include <array>
#include <vector>

#include "filter/edge_expert.h"
#include "filter/nearest_map.h"

namespace lcs {

class ConstellationEdges : public EdgeExpert {
 public:
  ConstellationEdges(const Intrinsics& camera, const CircleParameters& parameters);

  void predict(Layers& layers, const MotionField& field) override;
  void update(Layers& layers, const Chi& chi, const MotionField& field,
              std::vector<Verdict>& verdicts) override;

 private:
  /// The corners of an earlier frame, in this frame's pixels (rotation removed).
  struct Past {
    explicit Past(const Intrinsics& camera) : map(camera.width_px, camera.height_px) {}
    std::vector<Vec2> corners;
    NearestMap map;
    Eigen::Vector3d displacement_C_m = Eigen::Vector3d::Zero();  // of the camera since then
  };

  /// What is known of a corner while the frame is being explained.
  struct Candidate {
    bool residual = false;     ///< no trusted edge explains it
    int static_hits = 0;       ///< of the last two frames, at the best depth
    double static_ratio = 0;   ///< Z_ref / Z of that depth
    Vec2 step = Vec2::Zero();  ///< displacement that its neighbours voted for, px a frame
    bool voted = false;        ///< for a motion that no static point has
  };

  enum class Kind : std::uint8_t { none, normal, rebel };
  /// The edge that a corner belongs to.
  struct Link {
    Kind kind = Kind::none;
    int index = -1;
  };

  void remember(const Chi& chi);
  void assign(const Layers& layers, const Chi& chi, const MotionField& field);
  void update_normal(Edge& edge, const Vec2& x, const MotionField& field) const;
  void update_rebel(Edge& edge, const Vec2& x, const MotionField& field) const;
  void set_velocity(Edge& edge, const Vec2& velocity_pxps, double dt_s) const;
  double off_field(const Vec2& x, const Vec2& before, const MotionField& field) const;
  void find_residuals(const Layers& layers, const Chi& chi);
  void seek_static_past(const Chi& chi, const MotionField& field);
  int static_hits(const Vec2& x, double depth_ratio, const MotionField& field) const;
  void vote(const Chi& chi, const MotionField& field);
  Reason vote_on(std::size_t corner, const Chi& chi, const MotionField& field);
  int count_votes(const Chi& chi, const Vec2& x, const Vec2& before, double scale, int own,
                  int best) const;
  void settle_rebels();
  void make_edges(Layers& layers, const Chi& chi, const MotionField& field);
  Edge make_rebel(const Vec2& x, const Vec2& velocity_pxps, double dt_s);
  void support(Layers& layers, const MotionField& field);
  void smooth(std::vector<Edge>& rebels, double dt_s);
  void inherit(Layers& layers, const Chi& chi, const MotionField& field);
  bool confirms(const Vec2& x, const Vec2& step) const;

  CircleParameters parameters_;
  std::array<Past, 2> past_;  // of the last frame and the one before
  int remembered_ = 0;

  // Of the current frame; kept for their memory.
  PointGrid past_grid_, rebel_grid_;
  std::vector<Candidate> candidates_;
  std::vector<Link> links_;      // of each corner
  std::vector<char> borne_out_;  // of each rebel edge
  std::vector<Reason> support_;  // of each rebel edge, why it is not borne out
  std::vector<char> called_;     // corners that leave as rebels
  std::vector<std::pair<double, int>> near_;
  std::vector<int> voters_;
  std::vector<Vec2> points_;
  std::vector<int> component_;  // of each rebel edge
};

}  // namespace lcs
