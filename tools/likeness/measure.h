/// \file
/// What corners see of a pair of pictures: how many there are, how they move, whether they come
/// back. One definition for pictures of any origin, so that they can be held beside each other.
#pragma once

#include <array>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::likeness {

/// In the order of `measures`. Those of corners are medians over the corners of a picture.
enum class Measure {
  corners,
  corners_per_mpx,
  spacing_px,
  contrast,
  motion_px,
  direction_deg,
  one_way,
  outward,
  noise,
  followed,
  found_again,
  by_chance,
};
inline constexpr std::size_t kMeasures = 12;

struct MeasureText {
  std::string_view name;  ///< a column's
  std::string_view about;
  bool by_factors = false;  ///< plotted so that each factor takes the same room
};
const std::array<MeasureText, kMeasures>& measures();

/// The measures of one pair of frames; none where there are too few corners for it.
class Values {
 public:
  std::optional<double>& operator[](Measure m) { return all_[static_cast<std::size_t>(m)]; }
  const std::optional<double>& operator[](Measure m) const {
    return all_[static_cast<std::size_t>(m)];
  }

 private:
  std::array<std::optional<double>, kMeasures> all_;
};

/// \param now, next pictures of one size. \param threshold of FAST, as its detector takes it.
Values measure(const cv::Mat1b& now, const cv::Mat1b& next, std::optional<int> threshold);

/// The first frames of so many pairs of neighbours, spread over a run evenly; fewer where it is
/// short.
std::vector<int> spread(int frames, int pairs);

enum class Origin { world, suite, recording };

/// A run of pictures, a scenario's or a recording's.
struct Run {
  Origin origin = Origin::recording;
  std::string group, name;
  int frames = 0;
  std::optional<int> threshold = 20;
  /// Asked for each at most once, in rising order; empty for one that cannot be read.
  std::function<cv::Mat1b(int)> picture;
};

/// A pair of a run, by its first frame.
struct Row {
  Origin origin = Origin::recording;
  std::string group, run;
  int frame = 0;
  Values values;
};

/// \throws std::runtime_error for a run without a single pair that can be read.
std::vector<Row> measure(const Run& run, int pairs);

}  // namespace lcs::likeness
