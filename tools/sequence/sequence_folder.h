/// \file
/// The folder of a sequence while it is made. Frames are written into TARGET.unfinished, and become
/// the sequence at once. There, a journal of each process records the frames that it has finished,
/// by which work goes on after it was stopped, and by which several processes share a sequence.
/// TARGET.unfinished is kept from the first finished frame on: a sequence that fails before leaves
/// nothing.
///
/// `manifest.json`: the inputs and the generator of a sequence, and the SHA-256 of each of its
/// files. It is written last.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/input/input_file.h"
#include "tools/files/journal.h"
#include "tools/files/output.h"
#include "tools/files/provenance.h"
#include "tools/sequence/self_check.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {

inline constexpr const char* kManifestFile = "manifest.json";

struct FileRecord {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// Agreements by the name of what was compared, as "flow_px".
using Agreements = std::map<std::string, Agreement>;

/// The bytes of a file of a sequence. \throws input::Error
inline std::string read_file(const std::filesystem::path& path) {
  // the longest is a table of all frames
  return input::read_file(path, {16 * input::kGibibyte, "generate the sequence again"});
}

/// A finished frame.
struct FrameEntry {
  std::vector<FileRecord> files;
  Rows rows;
  Agreements checks;
};

class SequenceFolder {
 public:
  /// \param target the folder of the sequence.
  /// \param base folder of the scenario, to which the paths in the provenance are relative.
  /// \param adds formats are added to the finished sequence in the target.
  /// \param is_part other processes may fill the folder at the same time; never calls `finish`.
  /// \param wait called again and again while another process makes the whole sequence.
  /// \throws files::OutputError as `files::Output`; input::Error for an unreadable manifest.
  SequenceFolder(const std::filesystem::path& target, const std::filesystem::path& base, bool adds,
                 bool is_part, std::function<void()> wait);

  /// The formats of the finished sequence in the target; none if there is none.
  std::vector<std::string> formats() const;

  /// Compares the sequence with the one in the target, and with the unfinished one.
  /// \param facts all settings that determine its bytes.
  /// \return whether the target has it already, whole and as it was written.
  /// \throws files::OutputError that names the first difference of another sequence.
  bool is_complete(const files::Json& facts);

  /// Whether a frame is finished and its files are as they were written.
  bool is_whole(int frame);
  /// The number of finished frames.
  int recorded();
  /// \throws std::runtime_error for a frame that is not finished.
  const FrameEntry& read(int frame);

  /// Writes the files of a frame, then its entry. Does nothing if another process has finished the
  /// sequence. All files that determine the frame have been read. \throws files::OutputError
  void add(int frame, const FrameOutput& output, const Agreements& checks);

  /// Writes a file of the sequence. Leaves a file of the same bytes as it is.
  /// \throws files::OutputError
  void write(const std::filesystem::path& within, std::string_view bytes) const;

  /// Adds the files of a folder that another program makes.
  /// \param make called with the path of a folder to make, beside which it may have other files.
  /// \throws files::OutputError
  std::vector<FileRecord> add_folder(
      const std::filesystem::path& within,
      const std::function<void(const std::filesystem::path&)>& make) const;

  /// Writes the manifest, and moves the sequence to the target.
  /// \throws files::OutputError, also if there is a file that is none of `files`.
  void finish(const Agreements& checks, std::vector<FileRecord> files);

  const std::filesystem::path& target() const { return output_.target(); }
  /// Where the frames are until `finish`.
  const std::filesystem::path& staging() const { return output_.staging(); }

 private:
  std::filesystem::path plan_file() const { return output_.work() / "plan.json"; }
  void put(const std::filesystem::path& path, std::string_view bytes) const;
  void begin();
  void refresh();
  const FrameEntry* find(int frame);
  void take_earlier() const;
  std::string other_than(const files::Provenance& there,
                         std::span<const std::string_view> but = {}) const;

  files::Output output_;
  std::filesystem::path base_;
  bool adds_;
  std::optional<files::Provenance> finished_;  ///< of the sequence in the target
  files::Json facts_;
  std::optional<files::Journal> journal_;  ///< of this process
  std::map<std::filesystem::path, files::JournalReader> journals_;
  std::map<int, FrameEntry> entries_;
};

}  // namespace lcs::sequence
