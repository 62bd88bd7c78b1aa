#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "settings/kinds.hpp"

namespace adit::settings {

/// One key of the settings file.
struct Key {
  std::string_view path;  // "team.listen[].port"; "[]" stands for each item; `kind` refers to the last item
  std::string_view meaning;
  Kind kind;
  bool required = false;
};

/// The table of all keys, for the parser and README.md. Keys of one object are adjacent.
std::span<const Key> keys();

/// One list of the settings file.
struct List {
  std::string_view path;    // "team.listen"
  std::size_t least, most;  // items
  std::size_t (*size)(const Settings&);
  void (*resize)(Settings&, std::size_t);
};

/// Requires the path of a list.
const List& list_at(std::string_view path);
/// Default settings with one more item in each list, so that each key's kind can be read.
Settings with_an_item_of_each();

/// A named member of an object in the settings file.
struct Child {
  std::string_view name;
  const Key* key = nullptr;  // null for an object or a list
  bool list = false;
};

/// The members of the object at `prefix` ("team.listen[]."), in table order.
std::vector<Child> children_of(std::string_view prefix);

}  // namespace adit::settings
