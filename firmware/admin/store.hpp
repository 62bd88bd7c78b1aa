#pragma once

#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "host/service.hpp"
#include "icd/bearer_token.hpp"
#include "icd/redaction.hpp"
#include "settings/saved.hpp"
#include "settings/settings.hpp"

namespace adit::admin {

using settings::token_names;

/// Where settings and tokens are kept, and which of them count: those that were saved in the state folder, or
/// else those that the box was given.
///
/// Saved settings and tokens are on trial until settle(). revert() restores the earlier ones, also after a
/// crash or a power cut.
class Store {
 public:
  Store(std::string given_settings, std::string given_secrets, std::string state_folder);

  struct Loaded {
    settings::Settings settings;
    bool saved = false;
    bool is_damaged = false;  // the saved settings were read, and cannot be understood
    host::Secrets secrets;
    std::string trouble;  // why saved settings or tokens do not count, though there are any
  };
  /// Of the secrets that there are whatever the settings say: a sentence on what is wrong with these quotes
  /// them.
  icd::Redaction redaction() const;
  /// What counts. An error: neither can be used. Damaged saved settings are set aside.
  std::expected<Loaded, std::string> load();
  /// Why load() could not read a file, or "". Its result then is not the saved set-up, and the box must
  /// not use it. Until load() succeeds, save(), settle() and revert() change nothing.
  const std::string& unread() const { return unread_; }
  /// Whether load() could read all files now. Thread-safe.
  bool can_be_read() const;

  std::expected<void, std::string> save(const settings::Settings& settings);
  std::expected<void, std::string> save_token(const std::string& name,
                                              const std::optional<icd::BearerToken>& token);
  /// What counts works. Tokens of courses that there are no more are removed: nobody could see them.
  void settle(const settings::Settings& settings);
  /// False: nothing is on trial, or it failed.
  bool revert();
  /// Forgets all that was saved.
  std::expected<void, std::string> forget();

 private:
  std::string file() const { return state_ + '/' + settings::kSavedFile; }
  std::string file_before() const { return state_ + '/' + settings::kFileBefore; }
  std::string secrets_folder() const { return state_ + '/' + settings::kSecretsFolder; }
  std::string token_file(const std::string& name) const {
    return secrets_folder() + "/" + name + settings::kTokenEnding;
  }
  std::expected<void, std::string> make_secrets_folder();
  /// As load(); changes nothing on the disk.
  std::expected<Loaded, std::string> read(std::string& unread) const;

  const std::string given_settings_, given_secrets_, state_;
  std::string unread_;
};

}  // namespace adit::admin
