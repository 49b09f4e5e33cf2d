/// \file
/// Loops over columns of numbers, by the vector instructions that the machine has. The results have
/// the same bits on each machine: each is compiled from one source (`loops.inl`), without fused
/// multiplication, and sums have a fixed order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "filter/types/signature.h"
#include "filter/vectors/refill.h"

namespace lcs {

/// Items that a loop takes at once. Columns that a loop reads or writes have room for as many more.
inline constexpr std::size_t kLanes = 8;

/// Sets the column to `size` zeros, with room behind them for a loop.
template <typename T>
void refill_column(std::vector<T>& column, std::size_t size) {
  refill(column, size + kLanes);
}

/// Columns of nodes that may be tied (MODEL.md (19)), padded.
struct TieColumns {
  const float *x_px, *y_px, *step_x_px, *step_y_px;
  const float* reach2_px2;   ///< r^2; negative for a node without ties
  const float* length2_px2;  ///< square of the step, times the share by which steps may differ
  const float* variance_px2;
  float far2;  ///< bound of the exponent, and of the squared distance in units of `reach2_px2`
};

/// Ties of nodes to later ones: blocks of `kLanes` weights, 0 where there is no tie.
struct Ties {
  const std::size_t* first;     ///< of each node's blocks, and the end
  const std::uint32_t* starts;  ///< the first node of each block
  const float* weights;         ///< (19)
};

/// Columns of edges that may be linked (MODEL.md (23)), padded.
struct LinkColumns {
  const float *x_px, *y_px;
  const float* reach2_px2;  ///< square of the unit of distance
  const float* value;       ///< measured
  const float* variance;    ///< of the value; infinite where values are not compared
  float far2;  ///< bound of squared distances, in units and in deviations of the values
};

/// Columns of candidate pairs of corners and tracks, padded; a corner's pairs lie together.
struct PairColumns {
  const float *step_x_px, *step_y_px, *likeness;
  const std::uint32_t* counts;  ///< of each corner's pairs
  std::size_t places;           ///< for the pairs of each corner
  /// Variance on an axis of the difference of two steps of one body: this, and a share of the
  /// squared step (MODEL.md (7)).
  float variance_px2, share2;
};

struct Loops {
  /// Finds the points of a range that are within a radius of a point.
  /// \param found, distance2_px2 room for all of the range and `kLanes` more.
  /// \return how many were found.
  std::size_t (*within)(const float* x_px, const float* y_px, std::size_t first, std::size_t last,
                        float x0_px, float y0_px, float radius2_px2, int* found,
                        float* distance2_px2);
  std::size_t (*count_within)(const float* x_px, const float* y_px, std::size_t first,
                              std::size_t last, float x0_px, float y0_px, float radius2_px2);
  /// The place of each value among all, from 0 for the least; equal values keep their order.
  /// \param values, places padded.
  void (*ranks)(const float* values, std::size_t count, int* places);
  /// Finds the nodes of a range that are tied to a node, in blocks of `kLanes` nodes.
  /// \param starts room for all blocks: the first node of each. \param weights of their nodes.
  /// \return how many blocks have a tie.
  std::size_t (*ties)(const TieColumns& nodes, std::size_t node, float noise2_px2,
                      std::size_t first, std::size_t last, std::uint32_t* starts, float* weights);
  /// The sum over the ties of each node of weight times value; both padded.
  void (*tied_sums)(const Ties& ties, const float* values, std::size_t count, float* sums);
  /// Finds the nodes of a range that are linked to a node, within a radius of it.
  /// \param distances2 in units.
  std::size_t (*links)(const LinkColumns& nodes, std::size_t node, float radius2_px2,
                       std::size_t first, std::size_t last, int* found, float* distances2);
  /// values[i] = e^(factor values[i])
  void (*exponentials)(float* values, std::size_t count, float factor);
  /// tanh(m/2)
  void (*half_tanh)(const float* m, float* result, std::size_t count);
  /// Sums of the votes of neighbours for the steps of `kLanes` pairs: of the weight times
  /// ln((1 + V) / 2).
  /// \param neighbours corners. \param weights, ln_clutter of each. \param asked the first pair.
  void (*votes)(const PairColumns& pairs, const int* neighbours, const float* weights,
                const float* ln_clutter, std::size_t count, std::size_t asked, float* sums);
  /// Finds the signatures at some places of a list that are at most `most_bits` from one.
  /// \param found room for all.
  std::size_t (*alike)(const Signature& one, const Signature* many, const int* places,
                       std::size_t count, int most_bits, Alike* found);
};

/// The loops by the instructions that all machines have.
const Loops& plain_loops();

/// The loops by this machine's instructions.
const Loops& best_loops();
/// Whether this machine has the instructions of the files compiled with -mavx2 -mpopcnt, and they
/// were compiled.
bool has_avx2();
inline const Loops& loops() {
  static const Loops& best = best_loops();
  return best;
}

}  // namespace lcs
