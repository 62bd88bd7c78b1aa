#pragma once

#include <cstdint>
#include <string>

#include "picture/mosaic.hpp"

namespace adit::api {

/// The JSON of /adit/map: how tiles are cut and coloured, and every layer with the tiles that changed after
/// version `since`. README.md names the members.
std::string write_map(const picture::Mosaic& map, std::uint64_t since);

}  // namespace adit::api
