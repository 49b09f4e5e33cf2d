// The folder of a run, or of a suite: its files are read, or refused by an error that names one of
// them. A folder that is read is scored, and is unchanged after writing and reading again. An input
// holds the files, each after a line "=== NAME".
#include <cmath>
#include <stdexcept>

#include "scenarios/input/message.h"
#include "tests/fuzz/input.h"
#include "tests/scoring/whole_recordings.h"
#include "tools/output/frame_pictures.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/events.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/scoring.h"
#include "tools/suite/suite_result.h"

namespace {

using namespace lcs;
namespace fs = std::filesystem;

const cv::Size kSize_px(640, 480);

constexpr const char* kFiles[] = {
    recording::kLayersFile, recording::kTruthFile, scoring::kFramesFile, scoring::kMetricsFile,
    scoring::kEventsFile,   output::kPicturesFile, suite::kSuiteFile,
};

template <class Read>
void read_or_be_refused(const fs::path& folder, Read read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    const std::string said = input::message_of(error);
    fuzz::require(said.starts_with(folder.native()), "a refusal begins with the file");
    fuzz::require(said.find('\n') == said.npos, "a refusal is one line");
  }
}

void score_and_store(const fs::path& folder) {
  recording::Recording recording = recording::read_recording(folder);
  if (fs::exists(folder / scoring::kFramesFile)) {
    scoring::read_times(folder / scoring::kFramesFile, recording);
  }
  for (const auto& [name, figure] : scoring::score(recording)) {
    fuzz::require(!figure || std::isfinite(*figure), "figures are finite");
  }
  scoring::all_events(recording);
  const fs::path copy = folder / "copy";
  fs::create_directory(copy);
  recording::RecordingWriter writer(copy, recording);
  for (const recording::FrameRecord& frame : recording.frames) writer.write(frame);
  writer.close();
  const recording::Recording again = recording::read_recording(copy);
  fuzz::require(again.frames.size() == recording.frames.size(), "all frames are stored");
  for (std::size_t i = 0; i < again.frames.size(); ++i) {
    fuzz::require(
        recording::layers_line(again.frames[i]) == recording::layers_line(recording.frames[i]) &&
            recording::truth_line(again.frames[i]) == recording::truth_line(recording.frames[i]),
        "a frame is read as it was written");
  }
}

void decode(const output::FramePictures& pictures, std::size_t i) {
  try {
    double scale = 1;
    fuzz::require(!pictures.at(i, scale).empty(), "a picture has pixels");
  } catch (const std::runtime_error&) {
    // the folder is invalid
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path folder = fuzz::work_folder() / "run";
  fuzz::write_sections(folder, kFiles, fuzz::text_of(data, size));
  read_or_be_refused(folder, [&] { score_and_store(folder); });
  read_or_be_refused(folder, [&] { scoring::read_metrics(folder / scoring::kMetricsFile); });
  read_or_be_refused(folder, [&] { scoring::read_events(folder / scoring::kEventsFile); });
  read_or_be_refused(folder, [&] { suite::read_suite(folder); });
  read_or_be_refused(folder, [&] {
    const output::FramePictures pictures(folder / output::kPicturesFile, kSize_px);
    for (std::size_t i = 0; i < pictures.size(); ++i) decode(pictures, i);
  });
  return 0;
}
