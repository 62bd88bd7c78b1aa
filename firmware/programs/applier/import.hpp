#pragma once

#include <expected>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "applier/options.hpp"
#include "host/untrusted_folder.hpp"
#include "icd/bearer_token.hpp"
#include "network/numbers.hpp"
#include "settings/settings.hpp"

namespace adit::applier {

/// Files for the box that a user put on the boot partition. All have passed their checks.
struct CardContents {
  std::optional<settings::Settings> settings;
  std::optional<network::Numbers> numbers;
  std::map<std::string, icd::BearerToken> tokens;  // by file name: "scoring.token", or kCardCode

  bool nothing() const { return !settings && !numbers && tokens.empty(); }
};

struct CardResult {
  CardContents brought;
  std::vector<std::string> errors;      // "adit/settings.json: team.listen[0].port: ..."; if any, no file is
                                        // accepted
  std::vector<std::string> left_alone;  // names of ignored files
};

inline constexpr const char* kCardSettings = "settings.json";
inline constexpr const char* kCardNetwork = "network.json";
inline constexpr const char* kCardSecrets = "secrets";
inline constexpr const char* kCardCode = "label.code";  // in kCardSecrets: the code that the first password
                                                        // requires
inline constexpr const char* kTakenText = "taken.txt";
inline constexpr const char* kTakenEnding = ".taken";

/// Reads `card`, the directory "adit". `now`: the settings in force, unless the card brings others. A file
/// has at most UntrustedFolder::kLargest bytes. A byte order mark is removed.
CardResult read_card(const host::UntrustedFolder& card, const settings::Settings& now);

/// Imports the files on the boot partition into the box's state, all or none, and writes the result to
/// taken.txt.
///
/// Tokens are wiped and other files renamed only after the state is stored, so a power cut repeats or
/// finishes the import. If the state is in memory, the files stay and every start imports them. Run while
/// neither aditd nor adit-network runs.
class Import {
 public:
  /// `options` must outlive this object.
  explicit Import(const ImportOptions& options) : options_(options) {}

  /// Error: correct files could not be imported. Faults in the files are reported on the card and in the
  /// journal, and are not an error.
  std::expected<void, std::string> run();

 private:
  std::expected<settings::Settings, std::string> current_settings() const;
  std::expected<void, std::string> save(const CardContents& brought);
  std::expected<void, std::string> save_tokens(host::UntrustedFolder& state, const CardContents& brought);
  std::expected<void, std::string> save_settings(host::UntrustedFolder& state,
                                                 const settings::Settings& settings);

  const ImportOptions& options_;
};

}  // namespace adit::applier
