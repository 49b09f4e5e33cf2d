/// \file
/// Turns what MuJoCo says of a document into one line that names the user's own file, line and
/// element.
#pragma once

#include <filesystem>
#include <string>

#include "sim/xml.h"

namespace lcs::sim {

/// \param said MuJoCo's message, which may have several lines and name lines of the composed
///   document.
/// \param file the scene's, named where no line is known.
scenario::Error refusal(const std::string& said, const xml::Printed& scene,
                        const std::filesystem::path& file);

/// What MuJoCo says, in one line with what to do: "what; what to do".
/// \param more appended to "what", as " (body 'ball')".
std::string in_one_line(const std::string& said, const std::string& more = "");

}  // namespace lcs::sim
