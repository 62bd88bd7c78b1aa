#pragma once

#include <string>
#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

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
