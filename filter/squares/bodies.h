/// \file
/// Bodies that were seen to move. Each keeps its edges and its box while it is slow, stands or is
/// hidden, until something else is seen in its place (filter/MODEL.md, "Bodies that live on").
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/matching/members.h"
#include "filter/types/layers.h"

namespace lcs {

class Bodies {
 public:
  Bodies(const Intrinsics& camera, const EdgeParameters& edges, const TrustRanks& trust)
      : camera_(camera), edges_(edges), trust_(trust) {}

  /// The squares of a frame: one of each body in place of those of its circles. A body without a
  /// rebel circle in this frame has a square of 0 circles.
  /// \param squares of the circles; those of the rebel ones last, one each.
  /// \return valid until the next call.
  const std::vector<Square>& step(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                                  const std::vector<Square>& squares, const MotionField& field);

  /// Drops all bodies.
  void forget();

 private:
  struct Body {
    Square square;                      ///< as given out last, or predicted
    Vec2 centre_px = Vec2::Zero();      ///< its edges' places and its box are relative to this
    Eigen::AlignedBox2d box_px;         ///< relative to the centre; fused over time
    double weight = 0;                  ///< of the box
    Vec2 velocity_pxps = Vec2::Zero();  ///< rotation removed
    double unseen_s = 0;                ///< time since an edge of it was seen
    int next = -1;                      ///< its index in the next frame; -1: it ends
    struct Now {
      int parts = 0;                 ///< its edges that are seen
      int circles = 0;               ///< its rebel circles
      int shared = 0, first = -1;    ///< most edges shared with a circle, and that circle
      int largest = 0;               ///< edges of the largest of its circles
      int edges = 0;                 ///< its edges in its circles
      Eigen::AlignedBox2d range_px;  ///< of these, in the picture
    } now;                           ///< in this frame

    bool is_at(const Vec2& x_px) const {
      return ((x_px - square.location).cwiseAbs().array() <= square.half_size.array()).all();
    }
    bool holds(const Square& other) const {
      return is_at(other.location - other.half_size) && is_at(other.location + other.half_size);
    }
    Eigen::AlignedBox2d place_px() const {
      return {centre_px + box_px.min(), centre_px + box_px.max()};
    }
  };

  /// An edge of a body.
  struct Part {
    Id edge;
    int body;
    Vec2 off_px;  ///< its place, from the centre
  };

  /// A part that has a corner in this frame.
  struct Seen {
    int part;
    const Edge* edge;
  };

  void predict(const MotionField& field);
  void find_parts(const BothKinds<Edge>& edges);
  void claim(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
             std::span<const Square> rebels);
  void claim_static(const std::vector<Circle>& circles, std::span<const Square> squares);
  void follow(int body, const MotionField& field);
  void assign(const BothKinds<Edge>& edges, const BothKinds<int>& of_edges, int known);
  void measure(const std::vector<Circle>& circles, std::span<const Square> rebels,
               const MotionField& field);
  bool is_seen_through(int body, const BothKinds<Edge>& edges, const MotionField& field) const;
  void end(const BothKinds<Edge>& edges, const MotionField& field);
  void give_out(std::span<const Square> normal);
  bool is_sure(const Body& body) const { return body.square.trust >= trust_.maximum; }
  /// px^2: of the difference between the steps of a body and of an edge of it (MODEL.md (19)).
  double step_variance(const Vec2& step_px) const {
    return 2 * edges_.noise_px * edges_.noise_px +
           edges_.step_share * edges_.step_share * step_px.squaredNorm();
  }

  Intrinsics camera_;
  EdgeParameters edges_;
  TrustRanks trust_;
  std::vector<Body> bodies_;
  std::vector<Part> parts_;  // by rising edge id
  std::vector<Square> squares_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Seen> seen_;
  std::vector<int> body_of_seen_, shared_;
  BothKinds<int> body_of_circle_;
  std::vector<double> misses_px_;
  std::vector<Part> next_parts_;
  Members members_;
};

}  // namespace lcs
