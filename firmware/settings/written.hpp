#pragma once

#include <string>
#include <vector>

#include "codec/value.hpp"
#include "settings/settings.hpp"

namespace adit::settings {

/// The whole settings as an object, in the order of the keys, with all that is by default.
codec::Value value_of(const Settings& settings);

/// The same as a settings file: JSON for people, which parse() takes.
std::string file_of(const Settings& settings);

/// Names this version of the settings among others: the same for the same settings, in 16 hexadecimal digits.
std::string tag_of(const Settings& settings);

/// One setting that differs. An item of a list is known by its name where it has one: "robots[ugv1].alias".
struct Change {
  std::string path;
  codec::Value from, to;  // null: not there
};

/// In the order of the keys.
std::vector<Change> changes(const Settings& from, const Settings& to);

}  // namespace adit::settings
