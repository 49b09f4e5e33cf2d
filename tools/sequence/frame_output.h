/// \file
/// What one frame adds to a generated sequence: files of its own, and rows of files that grow with
/// every frame.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace lcs::sequence {

/// A file that belongs to one frame alone. Paths are relative to the sequence's folder.
struct FrameFile {
  std::string path;
  std::string bytes;
  std::string same_as;  ///< path of a file of this frame that it is another name of; no bytes then
};

/// Rows of one frame by the name of the stream that they belong to.
using Rows = std::map<std::string, std::string>;

struct FrameOutput {
  std::vector<FrameFile> files;
  Rows rows;
};

/// A piece of a document: text as it stands, or the rows of all frames in order.
struct Part {
  std::string text = {};
  std::string stream = {};     ///< "" for text
  std::string separator = {};  ///< between the rows of two frames that have some
};

/// A file of the whole sequence.
struct Document {
  std::string path;
  std::vector<Part> parts;
};

}  // namespace lcs::sequence
