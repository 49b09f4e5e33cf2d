/// \file
/// Pictures from files.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "scenarios/scenario.h"

namespace lcs::sim {

/// \param where the file is named. \param flags of `cv::imdecode`.
/// \return empty for what is no picture.
/// \throws scenario::Error for a file that cannot be read, as `scenario::InputFile`.
cv::Mat read_picture(const std::filesystem::path& file, const scenario::Source& where, int flags);

}  // namespace lcs::sim
