#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"

namespace adit::settings {

/// Data about one key of the settings file, for a form, help and the man page.
struct Key {
  std::string path;  // "team.listen[].port"; "[]" stands for each item
  std::string meaning, kind;
  bool required = false;
  codec::Value default_value;  // null: none
  std::string range;
  std::optional<std::vector<std::string>> words = std::nullopt;  // of a choice
  codec::Value least = {}, most = {};                            // of a number
};

/// All keys, in the order of the rows.
std::vector<Key> keys();

/// 1 to `longest` letters, digits, `_` and `-`.
bool is_word(std::string_view text, std::size_t longest);

/// A value for a sentence: short JSON, or its type ("an object").
std::string value_text(const codec::Value& value);

}  // namespace adit::settings
