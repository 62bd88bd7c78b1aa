#pragma once

#include <string>
#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

/// What of the settings lies in aditd's state folder, and counts before what the box was given.
inline constexpr const char* kSavedFile = "settings.json";
/// The settings that count again unless those saved last prove to work; kNoneBefore: the given ones.
inline constexpr const char* kFileBefore = "settings.json.before";
inline constexpr const char* kNoneBefore = "none\n";
/// The folder of the tokens, each in NAME.token.
inline constexpr const char* kSecretsFolder = "secrets";
inline constexpr const char* kTokenEnding = ".token";

/// The names of all tokens that there can be: "scoring", "mapping", "team", and two for each course.
std::vector<std::string> token_names(const Settings& settings);

}  // namespace adit::settings
