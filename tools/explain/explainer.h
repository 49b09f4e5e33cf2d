/// \file
/// Explains why the filter called a corner of a stored run a rebel, or did not: the filter goes
/// over the frames again, and each corner has the numbers of its verdict, with the equations of
/// filter/MODEL.md, and the cause of an error by the truth.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "filter/edges/explanation.h"
#include "tools/bench/detector.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/events.h"
#include "tools/scoring/score_rebels.h"

namespace lcs::explain {

/// A corner of a track in a frame.
struct Sighting {
  int frame;
  Verdict verdict;
  sim::CornerTruth truth;
  Vec2 place_px;
  double miss_static_px, miss_moving_px;  ///< distances from its predictions; NaN without one
  float log_odds, belief;                 ///< L (15) and m (18)
};

/// A frame of the run, and all that explains its corners.
struct Explained {
  recording::RunInfo run;
  FieldParameters field;
  recording::FrameRecord frame;
  std::vector<scoring::CornerOutcome> outcomes;  ///< of its corners
  std::map<Id, std::vector<Sighting>> tracks;    ///< that live then, with their sightings
  std::vector<std::optional<Explanation>> why;   ///< of its corners; absent if left out

  Vec2 place_px(std::size_t corner) const { return frame.corners_px.at(corner).cast<double>(); }
  /// The sightings of the corner's track up to this frame; empty if the corner was left out.
  std::span<const Sighting> history(std::size_t corner) const;
};

/// The same folder. \throws std::runtime_error with the remedy if it has no frames.
const std::filesystem::path& with_frames(const std::filesystem::path& run);

/// Reads a run frame by frame, and explains it. A frame takes the filter's time and its reading.
class Explainer {
 public:
  /// \param run folder with the layers and the truth of all frames.
  /// \param parameters of its filter.
  /// \throws as `with_frames`; std::runtime_error if another detector than the default filter made
  ///   them; otherwise as `RecordingReader`.
  Explainer(const std::filesystem::path& run, const AnyParameters& parameters);

  /// Goes on to the next frame. \return false after the last.
  /// \throws std::runtime_error if the filter does not come to the stored verdicts.
  bool next();

  /// The last frame that was read.
  const Explained& frame() const { return said_; }

 private:
  std::filesystem::path run_;
  recording::RecordingReader reader_;
  bench::LcsDetector detector_;
  int coast_frames_ = 0;
  scoring::RebelScorer scorer_;
  Explained said_;
};

/// Verdict and truth, and a line for each number; without a track only the first.
std::string text_of(const Explained& said, std::size_t corner);
/// A table of the sightings; "" without a track.
std::string history_text(const Explained& said, std::size_t corner);
/// The last column of that table: the verdict, and the object that the corner was on.
std::string verdict_text(const Explained& said, const Sighting& one);

/// All numbers of a corner's own; those that are not there are null.
nlohmann::ordered_json json_of(const Explanation& why);
/// The same, with the verdict, the truth and the history.
nlohmann::ordered_json json_of(const Explained& said, std::size_t corner);

/// All corners that the pictures of these events mark, for the page of a run. By the number of the
/// frame a list of {x, y, text}; a corner on a track also has
/// - `static` and `moving`: its predictions, [x, y] in pixels, null without one,
/// - `neighbours`: [x, y, k, tanh(m/2)] of each,
/// - `history`: [frame, miss of the static and of the moving prediction in pixels, L, m, verdict]
///   of each sighting.
/// It stops after `kMostBytes`.
/// \param check called for each frame; its exceptions end the work.
/// \throws as `Explainer`
nlohmann::ordered_json explained_views(const std::filesystem::path& run,
                                       const AnyParameters& parameters,
                                       const std::vector<scoring::ScoredEvent>& events,
                                       const std::function<void()>& check);

/// Limit of the texts of `explained_views`; the first frames have priority.
inline constexpr std::size_t kMostBytes = 3'000'000;

}  // namespace lcs::explain
