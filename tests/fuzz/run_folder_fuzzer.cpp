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
    bench::kLayersFile, bench::kTruthFile,    bench::kFramesFile, bench::kMetricsFile,
    bench::kEventsFile, bench::kPicturesFile, suite::kSuiteFile,
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
  bench::Recording recording = bench::read_recording(folder);
  if (fs::exists(folder / bench::kFramesFile)) {
    bench::read_times(folder / bench::kFramesFile, recording);
  }
  for (const auto& [name, figure] : bench::score(recording)) {
    fuzz::require(!figure || std::isfinite(*figure), "figures are finite");
  }
  bench::all_events(recording);
  const fs::path copy = folder / "copy";
  fs::create_directory(copy);
  bench::RecordingWriter writer(copy, recording);
  for (const bench::FrameRecord& frame : recording.frames) writer.write(frame);
  writer.close();
  const bench::Recording again = bench::read_recording(copy);
  fuzz::require(again.frames.size() == recording.frames.size(), "all frames are stored");
  for (std::size_t i = 0; i < again.frames.size(); ++i) {
    fuzz::require(bench::layers_line(again.frames[i]) == bench::layers_line(recording.frames[i]) &&
                      bench::truth_line(again.frames[i]) == bench::truth_line(recording.frames[i]),
                  "a frame is read as it was written");
  }
}

void decode(const bench::FramePictures& pictures, std::size_t i) {
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
  read_or_be_refused(folder, [&] { bench::read_metrics(folder / bench::kMetricsFile); });
  read_or_be_refused(folder, [&] { bench::read_events(folder / bench::kEventsFile); });
  read_or_be_refused(folder, [&] { suite::read_suite(folder); });
  read_or_be_refused(folder, [&] {
    const bench::FramePictures pictures(folder / bench::kPicturesFile, kSize_px);
    for (std::size_t i = 0; i < pictures.size(); ++i) decode(pictures, i);
  });
  return 0;
}
