/// \file
/// What MuJoCo says of a document, in one line that names the user's own file, line and element.
#pragma once

#include <filesystem>
#include <string>

#include "sim/xml.h"

namespace lcs::sim {

/// \param said by MuJoCo, in some lines, with lines of the composed document in it.
/// \param file the scene's, for what has no line.
scenario::Error refusal(const std::string& said, const xml::Printed& scene,
                        const std::filesystem::path& file);

/// What MuJoCo says, in one line with what to do: "what; what to do".
/// \param more to add to the what, as " (body 'ball')".
std::string in_one_line(const std::string& said, const std::string& more = "");

}  // namespace lcs::sim
