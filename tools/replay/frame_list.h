/// \file
/// Tables that say when the pictures of a folder or a video were taken.
#pragma once

#include <filesystem>
#include <string>

#include "tools/replay/recorded.h"

namespace lcs::replay {

/// Gives each frame the time that a table has for it. If a column holds names of the pictures, a
/// row belongs to the picture of its name, else row k to frame k. The times are in the column that
/// the header calls so, else in the first one that holds neither names nor counts 0, 1, 2, ...
/// Frames without a row are left out and counted.
/// \param time_unit s, ms, us or ns; "": as the table states it, or as a camera's rate needs it.
/// \throws input::Error if the table has no such column, or another length than there are frames.
void time_by_table(const std::filesystem::path& file, const std::string& time_unit,
                   Recorded& recorded);

}  // namespace lcs::replay
