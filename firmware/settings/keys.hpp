#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "settings/kinds.hpp"

namespace adit::settings {

/// One key of the settings file.
struct Key {
  std::string_view path;  // "team.listen[].port": "[]" stands for each item of a list; `kind` is of its last
  std::string_view meaning;
  Kind kind;
  bool required = false;
};

/// The one table of all keys: what the parser knows, and what README.md documents. Keys of one object stand
/// together.
std::span<const Key> keys();

/// One list of the settings file.
struct List {
  std::string_view path;    // "team.listen"
  std::size_t least, most;  // items
  std::size_t (*size)(const Settings&);
  void (*resize)(Settings&, std::size_t);
};

/// Requires a list's path.
const List& list_at(std::string_view path);
/// All lists with one item more, as by default: what each key's kind can be asked of.
Settings with_an_item_of_each();

/// What may stand under a name in an object of the settings file.
struct Child {
  std::string_view name;
  const Key* key = nullptr;  // nothing for an object or a list
  bool list = false;
};

/// The children of the object at `prefix` ("team.listen[]."), in the order of the table.
std::vector<Child> children_of(std::string_view prefix);

}  // namespace adit::settings
