/// \file
/// The output of one frame in a generated sequence: its own files, and rows of the files that all
/// frames share.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace lcs::sequence {

/// A file of one frame only. Paths are relative to the sequence's folder.
struct FrameFile {
  std::string path;
  std::string bytes;
  std::string same_as;  ///< path of an identical file of this frame; `bytes` is empty then
};

/// Rows of one frame by stream name.
using Rows = std::map<std::string, std::string>;

struct FrameOutput {
  std::vector<FrameFile> files;
  Rows rows;
};

/// A piece of a document: fixed text, or the rows of all frames in order.
struct Part {
  std::string text = {};
  std::string stream = {};     ///< "" for fixed text
  std::string separator = {};  ///< between the rows of two frames, if neither is empty
};

/// A file of the whole sequence.
struct Document {
  std::string path;
  std::vector<Part> parts;
};

/// \name The output of a camera at its own place: beside cam0's output in the folders that a rig
/// shares, else in the camera's own folder, laid out as cam0's output in the sequence's folder.
/// \param camera as "cam1"; "": cam0.
///@{
FrameOutput of_camera(const std::string& camera, FrameOutput output);
Document of_camera(const std::string& camera, Document document);
///@}

}  // namespace lcs::sequence
