#pragma once

#include <expected>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

using LoadedMap = std::variant<Grid, Cloud>;

/// Reads a map by its ending: .pgm (with the .yaml that map_saver writes beside it), .pcd or .ply. The error
/// names the file and says what in it is wrong. Files over 256 MiB are refused.
std::expected<LoadedMap, std::string> load_map(const std::filesystem::path& file);

/// The .pgm, .pcd and .ply files under `folder`, at any depth, in the order of their names.
std::expected<std::vector<std::filesystem::path>, std::string> find_maps(const std::filesystem::path& folder);

}  // namespace adit::robots
