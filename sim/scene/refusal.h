/// \file
/// Turns a MuJoCo message about a document into one line that names the user's file, line and
/// element.
#pragma once

#include <filesystem>
#include <string>

#include "sim/scene/xml.h"

namespace lcs::sim {

/// \param said MuJoCo's message; may have several lines and cite lines of the composed document.
/// \param file the scene's file, cited if the line is unknown.
input::Error refusal(const std::string& said, const xml::Printed& scene,
                     const std::filesystem::path& file);

/// MuJoCo's message in one line, with a remedy: "problem; remedy".
/// \param more appended to the problem, for example " (body 'ball')".
std::string in_one_line(const std::string& said, const std::string& more = "");

}  // namespace lcs::sim
