#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

/// What a running box knows of the board that it is.
struct Board {
  std::string name;            // "qemu-virt"
  std::string title;           // for people
  std::optional<Panel> panel;  // nothing: the settings' counts
};

/// The file of a board (board.json of an image). All errors at once, as of the settings; an unknown key is
/// one.
std::expected<Board, std::vector<Error>> parse_board(std::string_view json);

}  // namespace adit::settings
