/// \file
/// Line expert: removes invalid corners and those inside psi.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "filter/layers.h"
#include "filter/signature.h"

namespace lcs {

/// chi after the Line expert: the corners that are looked at, in an order that does not depend on
/// the caller's (nearest to the principal point first).
struct Chi {
  std::vector<Vec2> locations;        ///< px
  std::vector<int> sources;           ///< index of each in the caller's corners
  std::vector<Signature> signatures;  ///< of each; empty where the caller gives none
  /// Collector that each falls into, -1: a single landmark. Of the paper's rule alone.
  std::vector<int> groups;

  /// A corner at the very place of another one, which stands for both: it gets that one's verdict.
  struct Repeat {
    int source, of_source;  ///< indices in the caller's corners
  };
  std::vector<Repeat> repeats;

  std::size_t size() const { return locations.size(); }
};

/// True for x inside a region of psi, border included.
bool contains(const IgnoreRegion& region, const Vec2& x);
bool inside_any(std::span<const IgnoreRegion> regions, const Vec2& x);

class LineExpert {
 public:
  /// \param max_corners that are looked at: the nearest to the principal point.
  explicit LineExpert(const Intrinsics& camera,
                      std::size_t max_corners = std::numeric_limits<std::size_t>::max())
      : centre_px_(camera.centre_px),
        picture_{camera.width_px, camera.height_px},
        max_corners_(max_corners) {}

  /// \param signatures one for each corner, or none at all.
  /// \param chi its groups are left alone.
  /// \param verdicts one for each corner: set to `ignored` inside psi, to `pending` elsewhere.
  ///   Corners that are not in the picture stay `pending` and go no further, nor do those that
  ///   repeat another one.
  void collect(std::span<const Eigen::Vector2f> corners_px, std::span<const Signature> signatures,
               std::span<const IgnoreRegion> psi, Chi& chi, std::vector<Verdict>& verdicts);

 private:
  Vec2 centre_px_;
  Pixels picture_;
  std::size_t max_corners_;
  struct Entry {
    double distance2;
    Vec2 location;
    int source;
  };
  std::vector<Entry> entries_;
};

}  // namespace lcs
