#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

/// A running box's data about its board.
struct Board {
  std::string name;            // "qemu-virt"
  std::string title;           // for people
  std::optional<Panel> panel;  // nullopt: the settings' panel applies

  static const codec::Row kRow;
};

/// Parses an image's board.json. Returns all errors at once, as for the settings; unknown keys are errors.
std::expected<Board, std::vector<Error>> parse_board(std::string_view json);

}  // namespace adit::settings
