#include "admin/store.hpp"

#include <algorithm>
#include <filesystem>
#include <ranges>
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
  auto settings = host::parse_kept(file, parse);
  if (!settings) return std::unexpected(unread = settings.error());
  if (*settings) return std::move(**settings);
  return std::unexpected(file + ": " + settings::sentence_of(settings->error()));
}

/// False if it is unknown.
bool is_there(const std::string& file) {
  std::error_code unknown;
  return fs::exists(file, unknown);
}

/// A failure is logged.
void mark_saved(const std::string& file, const std::string& mark) {
  if (!is_there(file)) return;
  host::keep_copy(file);
  if (host::can_exist(mark)) return;
  host::log_failure(host::Level::Warning, "the loss of a saved file may not be noticed",
                    host::write_file(mark, "", host::kOursAlone));
}

/// On purpose, so it is no loss.
std::expected<void, std::string> remove_saved(const std::string& file, const std::string& mark) {
  ADIT_TRY(host::remove_file(mark));
  return host::remove_file(file);
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

std::expected<Store::LoadedSettings, std::string> Store::load() {
  unread_.clear();
  auto loaded = read(unread_);
  if (!loaded) return loaded;
  for (const std::string& path : loaded->settings.without_effect)
    host::log(host::Level::Notice, "the setting has no effect any more", {{"setting", path}});
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

/// Leaves out a later Adit's settings that this one does not know, so a reverted update keeps the others.
std::expected<Store::LoadedSettings, std::string> Store::read(std::string& unread) const {
  LoadedSettings loaded;
  loaded.saved = host::can_exist(file());
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
  if (!host::can_exist(file()) && is_there(mark()))
    loaded.trouble = "the saved settings are lost; the initial settings are in use: " + file() + " is gone";
  if (!loaded.saved) {
    const auto parse = [](std::string_view json) {
      auto settings = settings::parse(json);
      if (!settings) settings::find_places(json, settings.error());
      return settings;
    };
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
  if (!host::can_exist(file_before())) {
    std::expected<std::string, std::string> before = settings::kNoneBefore;
    if (host::can_exist(file())) before = host::read_file(file());
    if (!before) return std::unexpected(before.error());
    if (const auto kept = host::write_kept(file_before(), *before); !kept) return kept;
  }
  ADIT_TRY(host::write_kept(file(), settings::file_of(settings)));
  mark_saved(file(), mark());
  return {};
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
  ADIT_TRY(keep_replaced(name, token));
  if (!token) return remove_saved(token_file(name), token_mark(name));
  if (auto made = make_secrets_folder(); !made) return made;
  ADIT_TRY(host::write_kept(token_file(name), token->reveal() + "\n"));
  mark_saved(token_file(name), token_mark(name));
  return {};
}

std::expected<void, std::string> Store::keep_replaced(const std::string& name,
                                                      const std::optional<icd::BearerToken>& next) {
  constexpr std::size_t kMost = 64;
  const auto secrets = ADIT_TRY(host::read_secrets(given_secrets_, secrets_folder(), {{name}}));
  const auto present = secrets.token(name);
  if (!present || (next && next->reveal() == present->reveal())) return {};
  std::string lines = present->reveal() + "\n";
  for (const icd::BearerToken& each : secrets.replaced | std::views::take(kMost - 1)) {
    if (each.reveal() != present->reveal()) lines += each.reveal() + "\n";
  }
  ADIT_TRY(make_secrets_folder());
  return host::write_kept(secrets_folder() + '/' + host::kReplacedFile, lines);
}

void Store::settle(const settings::Settings& settings) {
  if (!unread_.empty()) return;
  const std::vector<std::string> names = token_names(settings);
  const auto files = host::names_in(secrets_folder());
  if (!files) host::log(host::Level::Warning, "unused tokens may remain", {{"why", files.error()}});
  for (const fs::path file : files.value_or(std::vector<std::string>())) {
    const bool known = std::ranges::find(names, file.stem().string()) != names.end();
    if (known || file.extension() != ".token") continue;
    host::log_failure(host::Level::Warning, "logs may show an unused token",
                      keep_replaced(file.stem(), std::nullopt));
    host::log_failure(host::Level::Warning, "unused tokens may remain",
                      remove_saved(secrets_folder() / file, token_mark(file.stem())));
  }
  mark_saved(file(), mark());
  for (const std::string& name : names) mark_saved(token_file(name), token_mark(name));
  if (!host::remove_file(file_before())) {
    host::log(host::Level::Warning, "cannot remove a file", {{"file", file_before()}});
  }
}

std::expected<void, std::string> Store::put_back() {
  const auto before = ADIT_TRY(host::read_file(file_before()));
  return before == settings::kNoneBefore ? remove_saved(file(), mark()) : host::write_kept(file(), before);
}

bool Store::revert() {
  if (!unread_.empty() || !host::can_exist(file_before())) return false;
  return host::log_failure(host::Level::Error, "cannot restore the previous settings", put_back()) &&
         host::remove_file(file_before());
}

std::expected<void, std::string> Store::forget() {
  const auto names = host::names_in(state_);
  if (!names) return std::unexpected(state_ + ": " + names.error());
  for (const std::string& name : *names) {
    if (name.ends_with(host::kSavedMark)) ADIT_TRY(host::remove_file(state_ + '/' + name));
  }
  std::error_code error;
  fs::remove_all(secrets_folder(), error);
  if (error) return std::unexpected(secrets_folder() + ": " + error.message());
  for (const std::string& each : {file_before(), file(), file() + host::kDamaged})
    ADIT_TRY(host::remove_file(each));
  return {};
}

}  // namespace adit::admin
