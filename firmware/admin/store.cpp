#include "admin/store.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "host/log.hpp"
#include "settings/written.hpp"

namespace adit::admin {
namespace {

namespace fs = std::filesystem;

/// So that the box still serves a page on which it can be set right.
void set_aside(const std::string& path, const std::string& why) {
  host::set_damaged_aside(path, "the saved set-up", why);
}

std::expected<settings::Settings, std::string> read_settings(const std::string& file) {
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(text.error());
  auto settings = settings::parse(*text);
  if (settings) return std::move(*settings);
  return std::unexpected(file + ": " + settings::sentence_of(settings.error()));
}

/// Those that were saved here. What a later Adit knew beside is left out: an update that was reverted must
/// not cost the rest of them.
std::expected<settings::Settings, std::string> read_saved(const std::string& file, std::string& trouble) {
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(text.error());
  auto saved = settings::parse_saved(*text);
  if (!saved) return std::unexpected(file + ": " + settings::sentence_of(saved.error()));
  if (!saved->passed_over.empty()) {
    trouble = "a later Adit saved the settings; these settings are ignored:";
    for (const std::string& path : saved->passed_over) trouble += " " + path;
    host::log(host::Level::Warning, trouble);
  }
  return std::move(saved->settings);
}

}  // namespace

Store::Store(std::string given_settings, std::string given_secrets, std::string state_folder)
    : given_settings_(std::move(given_settings)),
      given_secrets_(std::move(given_secrets)),
      state_(std::move(state_folder)) {}

icd::Redaction Store::redaction() const {
  const auto secrets = host::read_secrets(given_secrets_, secrets_folder(), token_names({}));
  return secrets ? secrets->redaction() : icd::Redaction();
}

std::expected<Store::Loaded, std::string> Store::load() {
  Loaded loaded;
  auto settings =
      host::may_exist(file()) ? read_saved(file(), loaded.trouble) : read_settings(given_settings_);
  loaded.saved = settings.has_value() && host::may_exist(file());
  if (!settings && host::may_exist(file())) {
    loaded.trouble =
        "the saved settings were set aside; the initial settings are in use: " + settings.error();
    set_aside(file(), loaded.trouble);
    settings = read_settings(given_settings_);
  }
  if (!settings) return std::unexpected(settings.error());
  loaded.settings = std::move(*settings);
  const std::vector<std::string> names = token_names(loaded.settings);
  auto secrets = host::read_secrets(given_secrets_, secrets_folder(), names);
  if (!secrets && secrets.error().in == host::SecretsError::In::Saved) {
    loaded.trouble =
        "the saved tokens were set aside; the initial tokens are in use: " + secrets.error().sentence;
    set_aside(secrets_folder(), loaded.trouble);
    secrets = host::read_secrets(given_secrets_, secrets_folder(), names);
  }
  if (!secrets) return std::unexpected(secrets.error().sentence);
  loaded.secrets = std::move(*secrets);
  return loaded;
}

/// An empty file of settings before stands for none.
std::expected<void, std::string> Store::save(const settings::Settings& settings) {
  if (!host::may_exist(file_before())) {
    const auto before =
        host::may_exist(file()) ? host::read_file(file()) : std::expected<std::string, std::string>("");
    if (!before) return std::unexpected(before.error());
    if (const auto kept = host::write_file(file_before(), *before, host::kOursAlone); !kept) return kept;
  }
  return host::write_file(file(), settings::file_of(settings), host::kOursAlone);
}

std::expected<void, std::string> Store::make_secrets_folder() {
  std::error_code error;
  fs::create_directories(secrets_folder(), error);
  if (!error) fs::permissions(secrets_folder(), fs::perms::owner_all, error);
  if (error) return std::unexpected(secrets_folder() + ": " + error.message());
  return {};
}

std::expected<void, std::string> Store::save_token(const std::string& name,
                                                   const std::optional<icd::BearerToken>& token) {
  if (!token) return host::remove_file(token_file(name));
  if (auto made = make_secrets_folder(); !made) return made;
  return host::write_file(token_file(name), token->reveal() + "\n", host::kOursAlone);
}

void Store::settle(const settings::Settings& settings) {
  const std::vector<std::string> names = token_names(settings);
  const auto files = host::names_in(secrets_folder());
  if (!files) host::log(host::Level::Warning, "unused tokens may remain", {{"why", files.error()}});
  for (const fs::path file : files.value_or(std::vector<std::string>())) {
    const bool known = std::ranges::find(names, file.stem().string()) != names.end();
    if (known || file.extension() != ".token") continue;
    if (const auto removed = host::remove_file(secrets_folder() / file); !removed)
      host::log(host::Level::Warning, "unused tokens may remain", {{"why", removed.error()}});
  }
  if (!host::remove_file(file_before())) {
    host::log(host::Level::Warning, "cannot remove a file", {{"file", file_before()}});
  }
}

bool Store::revert() {
  const auto before = host::read_file(file_before());
  if (!before) return false;
  if (before->empty()) {
    if (!host::remove_file(file())) return false;
  } else if (const auto written = host::write_file(file(), *before, host::kOursAlone); !written) {
    host::log(host::Level::Error, "cannot write the previous settings", {{"why", written.error()}});
    return false;
  }
  return host::remove_file(file_before()).has_value();
}

std::expected<void, std::string> Store::forget() {
  std::error_code error;
  for (const std::string& folder : {secrets_folder(), secrets_folder() + host::kDamaged}) {
    fs::remove_all(folder, error);
    if (error) return std::unexpected(folder + ": " + error.message());
  }
  for (const std::string& each : {file_before(), file(), file() + host::kDamaged}) {
    if (auto removed = host::remove_file(each); !removed) return removed;
  }
  return {};
}

}  // namespace adit::admin
