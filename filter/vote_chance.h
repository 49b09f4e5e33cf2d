/// \file
/// How many votes chance gives a motion. Where corners lie close, every displaced constellation
/// finds some predecessors; where they are few, two that agree are no chance. So the votes that a
/// motion needs are not a share that is set but follow from how close corners lie: an a-contrario
/// test (Desolneux, Moisan and Morel, "Meaningful alignments", 2000).
#pragma once

#include <vector>

namespace lcs {

class VoteChance {
 public:
  /// \param hit_1_px, hit_2_px how near a predecessor counts, one baseline and two ago.
  /// \param max_voters neighbours that vote, at the most.
  /// \param false_motions that chance may bear out at a corner, in the mean over corners.
  VoteChance(double hit_1_px, double hit_2_px, int max_voters, double false_motions);

  /// The least number of votes that chance gives to fewer than `false_motions` of `tries`
  /// displacements. A corner whose predecessor is the displacement's has one vote and one more for
  /// a predecessor of that, and so has each voter once its predecessor is found: 2 (voters + 1) in
  /// all, and one at the least. More than all of them: all are what chance gives too.
  /// \param corners_ppx2 earlier corners in a square pixel round here.
  /// \param voters 0 .. max_voters
  int least(double corners_ppx2, int voters, double tries) const;

 private:
  /// By votes: the probability that chance gives as many or more, of 0 to 2 (voters + 1) votes.
  using AtLeast = std::vector<double>;

  double hit_1_px2_, false_motions_;
  std::vector<double> levels_;                  // corners expected about a place, rising
  std::vector<std::vector<AtLeast>> at_least_;  // of each level, by voters
};

}  // namespace lcs
