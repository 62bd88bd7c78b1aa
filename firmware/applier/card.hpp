#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/untrusted_folder.hpp"
#include "icd/bearer_token.hpp"
#include "network/numbers.hpp"
#include "settings/settings.hpp"

namespace adit::applier {

/// What somebody put on the boot partition for the box, by a card reader. All of it has passed its checks.
struct Brought {
  std::optional<settings::Settings> settings;
  std::optional<network::Numbers> numbers;
  std::map<std::string, icd::BearerToken> tokens;  // by the name of the file: "scoring.token", or kCardCode

  bool nothing() const { return !settings && !numbers && tokens.empty(); }
};

/// What was found on a card.
struct Found {
  Brought brought;
  std::vector<std::string> errors;  // "adit/settings.json: team.listen[0].port: ..."; then nothing is taken
  std::vector<std::string> left_alone;  // names of other files
};

inline constexpr const char* kCardSettings = "settings.json";
inline constexpr const char* kCardNetwork = "network.json";
inline constexpr const char* kCardSecrets = "secrets";
inline constexpr const char* kCardCode = "label.code";  // of kCardSecrets: what the first password asks for
inline constexpr const char* kTakenText = "taken.txt";
inline constexpr const char* kTakenEnding = ".taken";

/// Reads `card`, its folder "adit". `now`: the settings that are in force unless the card brings others. A
/// file is at most UntrustedFolder::kLargest bytes; a byte order mark, as some editors leave, is cut.
Found read_card(const host::UntrustedFolder& card, const settings::Settings& now);

}  // namespace adit::applier
