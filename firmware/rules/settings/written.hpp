#pragma once

#include <string>
#include <vector>

#include "codec/value.hpp"
#include "settings/settings.hpp"

namespace adit::settings {

/// All settings as an object in key order, with defaults.
codec::Value value_of(const Settings& settings);

/// The settings file: JSON for people, which parse() accepts.
std::string file_of(const Settings& settings);

/// Identifies the settings by 16 hexadecimal digits; equal settings have equal tags.
std::string tag_of(const Settings& settings);

/// A changed setting. An item of a list is identified by its name, if any: "robots[ugv1].alias".
struct Change {
  std::string path;
  codec::Value from, to;  // null: absent
};

/// In key order.
std::vector<Change> changes(const Settings& from, const Settings& to);

/// The saved settings in aditd's state directory, which precede the given ones.
inline constexpr const char* kSavedFile = "settings.json";
/// The previous settings, while the saved ones are on trial. kNoneBefore: the given ones applied.
inline constexpr const char* kFileBefore = "settings.json.before";
inline constexpr const char* kNoneBefore = "none\n";
/// The directory of the tokens, each in NAME.token.
inline constexpr const char* kSecretsFolder = "secrets";
inline constexpr const char* kTokenEnding = ".token";

/// The names of all possible tokens: "scoring", "mapping", "team", and two for each course.
std::vector<std::string> token_names(const Settings& settings);

}  // namespace adit::settings
