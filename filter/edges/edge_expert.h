/// \file
/// Circle expert, first part: which corner belongs to which edge, which edges are new, and which
/// are rebels. Two rules for it stand side by side; what they share is here.
///
/// Both predict normal edges by the motion field and rebels by their own motion, assign corners to
/// edges one to one, and give trust. They differ in how they recognise a rebel: `PaperEdges` by
/// single corners that line up over three frames (alpha), `HypothesisEdges` by how much likelier
/// each sighting is for a mover than for a static point.
#pragma once

#include <memory>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/line/line.h"
#include "filter/parameters.h"
#include "filter/reason.h"

namespace lcs {

class EdgeExpert {
 public:
  virtual ~EdgeExpert() = default;

  /// Moves edges, and what else is remembered, to where they should be in this frame.
  virtual void predict(Layers& layers, const MotionField& field) = 0;

  /// Matches, estimates, updates trust, deletes, and makes new edges.
  /// \param verdicts by the caller's order; `normal` or `rebel` is written for decided corners.
  virtual void update(Layers& layers, const Chi& chi, const MotionField& field,
                      std::vector<Verdict>& verdicts) = 0;

  /// Forgets all that it keeps of former frames, but for the layers.
  virtual void forget() {}

  /// Whether it forgot all in the last update, as the corners contradicted the told motion.
  bool began_anew() const { return began_anew_; }

  /// The reason for the verdict on each corner of the last chi.
  const std::vector<Reason>& reasons() const { return reasons_; }

 protected:
  EdgeExpert(const Intrinsics& camera, const TrustRanks& trust) : camera_(camera), trust_(trust) {}

  /// Deletes what is no longer trusted, or has left the image.
  void bury(std::vector<Edge>& edges) const;

  /// Gives an edge the origin, speed and angle that a static point of its depth has where it is.
  void move_as_static(Edge& edge, const MotionField& field) const;

  Id next_id() { return next_id_++; }

  const Intrinsics camera_;
  const TrustRanks trust_;
  std::vector<Reason> reasons_;
  bool began_anew_ = false;

 private:
  Id next_id_ = 1;
};

/// The rule that the parameters name.
std::unique_ptr<EdgeExpert> make_edge_expert(const Intrinsics& camera,
                                             const CircleParameters& parameters);

}  // namespace lcs
