#pragma once

#include <span>
#include <string_view>

#include "settings/kinds.hpp"

namespace adit::settings {

/// One key of the settings file.
struct Key {
  std::string_view path;  // "team.listen[].port": "[]" stands for each item of a list, the last of Settings'
  std::string_view meaning;
  Kind kind;
  bool required = false;
};

/// The one table of all keys: what the parser knows, and what README.md documents. Keys of one object stand
/// together.
std::span<const Key> keys();

}  // namespace adit::settings
