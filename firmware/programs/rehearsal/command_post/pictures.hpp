#pragma once

#include <cstddef>
#include <string>

#include "rehearsal/command_post/messages.hpp"

namespace adit::rehearsal {

/// How many bytes the picture of a map will take on the disk, about.
std::size_t picture_size(const MapMessage& map);

/// Writes `stem`.pgm as ROS's map_saver would draw it (254 free to 0 occupied, 205 unknown, the first row at
/// the bottom; each value from 0 to 100 has its own grey) and `stem`.yaml beside it. False: the disk did not
/// take it.
bool write_grid_picture(const Grid& grid, const std::string& cells, const std::string& stem);

/// Writes `stem`.pcd, PCD v0.7, binary: the message's fields without the gaps between them, little-endian,
/// its origin as the VIEWPOINT. What is left over after the last whole point is not written.
bool write_cloud_picture(const Cloud& cloud, const std::string& data, const std::string& stem);

/// `text` with all but letters, digits and underscores made underscores, at most 32 characters: safe as part
/// of a file's name and as a word of a PCD header.
std::string tame(std::string_view text);

}  // namespace adit::rehearsal
