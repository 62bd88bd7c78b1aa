#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "rehearsal/robots/maps/map_yaml.hpp"
#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// A binary PGM (P5, one byte a cell) as map_server reads it: dark is occupied (100), light is free (0), in
/// between is unknown; the first row is the top of the map, and so the last of the grid.
std::expected<Grid, std::string> parse_pgm(std::string_view bytes, const MapYaml& yaml);

}  // namespace adit::robots
