#include "admin/store.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "host/log.hpp"
#include "icd/try.hpp"
#include "settings/written.hpp"

namespace adit::admin {
namespace {

namespace fs = std::filesystem;

/// Parses a file's text. Sets `unread` if the file cannot be read.
template <class Parse>
auto read_settings(const std::string& file, Parse parse, std::string& unread)
    -> std::expected<typename decltype(parse(""))::value_type, std::string> {
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(unread = text.error());
  auto settings = parse(*text);
  if (settings) return std::move(*settings);
  return std::unexpected(file + ": " + settings::sentence_of(settings.error()));
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
  unread_.clear();
  auto loaded = read(unread_);
  if (!loaded) return loaded;
  // A box with damaged settings must still serve the page that corrects them.
  if (loaded->is_damaged) {
    host::set_damaged_aside(file(), "the saved set-up", loaded->trouble);
  } else if (!loaded->trouble.empty()) {
    host::log(host::Level::Warning, loaded->trouble);
  }
  return loaded;
}

bool Store::can_be_read() const {
  std::string unread;
  return read(unread) && unread.empty();
}

/// Leaves out settings of a later Adit that this one does not know, so that a reverted update preserves the
/// others.
std::expected<Store::Loaded, std::string> Store::read(std::string& unread) const {
  Loaded loaded;
  loaded.saved = host::may_exist(file());
  if (loaded.saved) {
    auto saved = read_settings(file(), settings::parse_saved, unread);
    loaded.saved = saved.has_value();
    loaded.is_damaged = !saved && unread.empty();
    if (loaded.is_damaged)
      loaded.trouble = "the saved settings were set aside; the initial settings are in use: " + saved.error();
    if (saved && !saved->passed_over.empty()) {
      loaded.trouble = "a later Adit saved the settings; these settings are ignored:";
      for (const std::string& path : saved->passed_over) loaded.trouble += " " + path;
    }
    if (saved) loaded.settings = std::move(saved->settings);
  }
  if (!loaded.saved) {
    const auto parse = [](std::string_view json) { return settings::parse(json); };
    auto given = ADIT_TRY(read_settings(given_settings_, parse, unread));
    loaded.settings = std::move(given);
  }
  auto secrets = ADIT_TRY(host::read_secrets(given_secrets_, secrets_folder(), token_names(loaded.settings)));
  if (unread.empty()) unread = secrets.unread;
  for (const auto& [name, why] : secrets.damaged)
    loaded.trouble += (loaded.trouble.empty() ? "" : "; ") + why;
  loaded.secrets = std::move(secrets);
  return loaded;
}

std::expected<void, std::string> Store::save(const settings::Settings& settings) {
  if (!unread_.empty()) return std::unexpected(unread_);
  if (!host::may_exist(file_before())) {
    std::expected<std::string, std::string> before = settings::kNoneBefore;
    if (host::may_exist(file())) before = host::read_file(file());
    if (!before) return std::unexpected(before.error());
    if (const auto kept = host::write_kept(file_before(), *before); !kept) return kept;
  }
  return host::write_kept(file(), settings::file_of(settings));
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
  return host::write_kept(token_file(name), token->reveal() + "\n");
}

void Store::settle(const settings::Settings& settings) {
  if (!unread_.empty()) return;
  const std::vector<std::string> names = token_names(settings);
  const auto files = host::names_in(secrets_folder());
  if (!files) host::log(host::Level::Warning, "unused tokens may remain", {{"why", files.error()}});
  for (const fs::path file : files.value_or(std::vector<std::string>())) {
    const bool known = std::ranges::find(names, file.stem().string()) != names.end();
    if (known || file.extension() != ".token") continue;
    host::log_failure(host::Level::Warning, "unused tokens may remain",
                      host::remove_file(secrets_folder() / file));
  }
  if (!host::remove_file(file_before())) {
    host::log(host::Level::Warning, "cannot remove a file", {{"file", file_before()}});
  }
}

std::expected<void, std::string> Store::put_back() {
  const auto before = ADIT_TRY(host::read_file(file_before()));
  return before == settings::kNoneBefore ? host::remove_file(file()) : host::write_kept(file(), before);
}

bool Store::revert() {
  if (!unread_.empty() || !host::may_exist(file_before())) return false;
  return host::log_failure(host::Level::Error, "cannot restore the previous settings", put_back()) &&
         host::remove_file(file_before());
}

std::expected<void, std::string> Store::forget() {
  std::error_code error;
  fs::remove_all(secrets_folder(), error);
  if (error) return std::unexpected(secrets_folder() + ": " + error.message());
  for (const std::string& each : {file_before(), file(), file() + host::kDamaged}) {
    if (auto removed = host::remove_file(each); !removed) return removed;
  }
  return {};
}

}  // namespace adit::admin
