/// \file
/// The pictures of a folder: their order, and their times where their names are times.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lcs::replay {

/// Whether a name has the ending of a PNG, JPEG, BMP, TIFF, WebP, PGM or PPM file.
bool is_picture(const std::filesystem::path& file);

/// The PNG, JPEG, BMP, TIFF, WebP, PGM and PPM files of a folder, in any order.
/// \throws std::runtime_error for a folder that cannot be read or has no picture.
std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder);

/// The number in each name that counts the pictures, where only one varies: 20 in frame_000020.png.
/// Empty if no number does, if two names have the same one, or if one exceeds a hundred million, as
/// times do.
std::vector<std::size_t> numbers_in(const std::vector<std::filesystem::path>& files);

struct OrderedPictures {
  std::vector<std::filesystem::path> files;
  std::vector<std::int64_t> t_ns;  ///< increasing; empty if the names are no times
};

/// Sorts pictures by the numbers in their names: frame2.png precedes frame10.png. A number may have
/// a fraction. Names are times if they are seconds with a fraction, seconds and nanoseconds, or ms,
/// us or ns since 1970, at the rate of a camera; or if `time_unit` (s, ms, us or ns) is given.
/// \throws input::Error that names the folder if two orders are possible: two numbers vary
/// independently, two names have the same numbers, or only some names have numbers.
OrderedPictures in_order(std::vector<std::filesystem::path> files, const std::string& time_unit);

}  // namespace lcs::replay
