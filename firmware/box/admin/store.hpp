#pragma once

#include <expected>
#include <optional>
#include <string>

#include "host/service.hpp"
#include "icd/bearer_token.hpp"
#include "settings/settings.hpp"
#include "settings/written.hpp"

namespace adit::admin {

using settings::token_names;

/// Stores settings and tokens. The saved ones in the state directory apply, or else the given ones. Saved
/// ones are on trial until settle(); revert() restores the earlier settings, even after a crash.
class Store {
 public:
  Store(std::string given_settings, std::string given_secrets, std::string state_folder);

  struct LoadedSettings {
    settings::Settings settings;
    bool saved = false;
    bool is_damaged = false;  // the saved settings could be read, but not parsed
    host::Secrets secrets;
    std::string trouble;  // why existing saved settings or tokens are not used
  };
  /// Redacts all stored secrets, because an error about them quotes them.
  icd::Redaction redaction() const;
  /// Loads the configuration that applies. Error: neither can be used. Damaged saved settings are set aside.
  std::expected<LoadedSettings, std::string> load();
  /// Why load() could not read a file, or "". The box must not use that result. Until load() succeeds,
  /// save(), settle() and revert() change nothing.
  const std::string& unread() const { return unread_; }
  /// Whether load() could read all files now. Thread-safe.
  bool can_be_read() const;

  std::expected<void, std::string> save(const settings::Settings& settings);
  std::expected<void, std::string> save_token(const std::string& name,
                                              const std::optional<icd::BearerToken>& token);
  /// Ends the trial. Removes deleted courses' tokens, which no page shows; marks files (host::kSavedMark).
  void settle(const settings::Settings& settings);
  /// False: there is no trial, or the revert failed.
  bool revert();
  /// Deletes all that was saved.
  std::expected<void, std::string> forget();

 private:
  std::string file() const { return state_ + '/' + settings::kSavedFile; }
  std::string mark() const { return file() + host::kSavedMark; }
  std::string file_before() const { return state_ + '/' + settings::kFileBefore; }
  std::string secrets_folder() const { return state_ + '/' + settings::kSecretsFolder; }
  std::string token_file(const std::string& name) const {
    return secrets_folder() + "/" + name + settings::kTokenEnding;
  }
  std::string token_mark(const std::string& name) const { return host::token_mark(secrets_folder(), name); }
  std::expected<void, std::string> make_secrets_folder();
  /// Keeps the present token of this name out of logs and exports, if it is another one than `next`.
  std::expected<void, std::string> keep_replaced(const std::string& name,
                                                 const std::optional<icd::BearerToken>& next);
  std::expected<void, std::string> put_back();
  /// As load(), without changes on disk.
  std::expected<LoadedSettings, std::string> read(std::string& unread) const;

  const std::string given_settings_, given_secrets_, state_;
  std::string unread_;
};

}  // namespace adit::admin
