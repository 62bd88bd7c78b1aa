#include "applier/import.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "access/password.hpp"
#include "codec/json.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "network/check.hpp"
#include "network/messages.hpp"
#include "settings/written.hpp"

namespace adit::applier {
namespace {

using host::UntrustedFolder;
using settings::Settings;

/// Reads one card.
class Reader {
 public:
  Reader(const UntrustedFolder& card, const Settings& now) : card_(card), now_(now) {}

  CardResult read() && {
    read_names();
    read_settings();
    read_network();
    read_secrets();
    return std::move(found_);
  }

 private:
  void refuse(const std::string& name, const std::string& what) {
    found_.errors.push_back(icd::sentence("adit/", host::escape(name), ": ", host::escape(what)));
  }
  void refuse(const std::string& name, const std::vector<settings::Error>& errors) {
    for (const settings::Error& error : errors) refuse(name, error.sentence());
  }

  /// The content of a file of `folder`. Errors call the file `name`.
  std::optional<std::string> text_of(const UntrustedFolder& folder, const std::string& file,
                                     const std::string& name) {
    static constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    auto text = folder.read(file);
    if (!text) {
      refuse(name, text.error().substr(std::min(text.error().size(), file.size() + 2)));
      return std::nullopt;
    }
    if (*text && (*text)->starts_with(kByteOrderMark)) (*text)->erase(0, kByteOrderMark.size());
    return std::move(*text);
  }

  void read_names() {
    const auto names = card_.names();
    if (!names) return refuse("", names.error());
    for (const std::string& written : *names) {
      std::string name = written;  // FAT ignores case
      std::ranges::transform(name, name.begin(), icd::lower);
      const bool known =
          name == kCardSettings || name == kCardNetwork || name == kCardSecrets || is_spent(name);
      if (!known) found_.left_alone.push_back(written);
    }
  }

  /// Whether the file was accepted before, is Adit's own, or is a desktop's hidden file.
  static bool is_spent(const std::string& name) {
    return name.starts_with('.') || name.ends_with(kTakenEnding) || name == kTakenText;
  }

  void read_settings() {
    const auto text = text_of(card_, kCardSettings, kCardSettings);
    if (!text) return;
    auto settings = settings::parse(*text);
    if (!settings) {
      settings::find_places(*text, settings.error());
      return refuse(kCardSettings, settings.error());
    }
    found_.brought.settings = std::move(*settings);
  }

  const Settings& counting() const { return found_.brought.settings ? *found_.brought.settings : now_; }

  void read_network() {
    const auto text = text_of(card_, kCardNetwork, kCardNetwork);
    if (!text) return;
    const auto value = codec::parse_json(*text);
    if (!value) return refuse(kCardNetwork, value.error());
    const auto numbers = numbers_of(*value, *text);
    if (!numbers) return refuse(kCardNetwork, numbers.error());
    const Settings settings = settings::effective_settings(counting());
    const auto findings = network::check(*numbers, std::nullopt,
                                         {.allow_overlap = settings.network.allow_overlap,
                                          .confirm_within = settings.network.confirm_within,
                                          .command_post = settings.command_post,
                                          .courses = settings.courses,
                                          .listen = settings.team.listen,
                                          .asker = "",
                                          .name = ""});
    if (!findings.errors.empty()) return refuse(kCardNetwork, findings.errors);
    found_.brought.numbers = *numbers;
  }

  /// Reads bare numbers, or numbers with a format as in the files of the image and of adit-network.
  static std::expected<network::Numbers, std::vector<settings::Error>> numbers_of(const codec::Value& value,
                                                                                  const std::string& text) {
    const auto* object = std::get_if<codec::Value::Object>(&value.is);
    const bool has_format = object != nullptr && codec::find_member(*object, "format") != nullptr;
    if (!has_format) return network::read_numbers(value);
    auto numbers = network::read_kept(text);
    if (!numbers) return std::unexpected(std::vector<settings::Error>{{"", std::move(numbers.error())}});
    return *numbers;
  }

  void read_secrets() {
    const auto folder = card_.folder(kCardSecrets);
    if (!folder) return refuse(kCardSecrets, "expected a directory");
    if (!*folder) return;
    const auto names = (*folder)->names();
    if (!names) return refuse(kCardSecrets, names.error());
    for (const std::string& name : *names) {
      if (!is_spent(name)) read_token(**folder, name);
    }
  }

  void read_token(const UntrustedFolder& folder, const std::string& file) {
    const std::string name = icd::sentence(kCardSecrets, "/", file);
    if (file == kCardCode) return read_code(folder, name);
    auto known = settings::token_names(counting());
    for (std::string& each : known) each += settings::kTokenEnding;
    if (std::ranges::find(known, file) == known.end())
      return refuse(name,
                    icd::sentence("unknown name; expected one of ", icd::join_words(known), ", ", kCardCode));
    const auto text = text_of(folder, file, name);
    if (!text) return;
    auto token = icd::BearerToken::parse_file(*text);
    if (!token) return refuse(name, "expected one token of 1 to 256 visible ASCII characters");
    found_.brought.tokens.emplace(file, std::move(*token));
  }

  void read_code(const UntrustedFolder& folder, const std::string& name) {
    const auto text = text_of(folder, kCardCode, name);
    if (!text) return;
    auto code = icd::BearerToken::parse_file(*text);
    if (!code || !access::is_code(code->reveal())) return refuse(name, "expected 8 digits");
    found_.brought.tokens.emplace(kCardCode, std::move(*code));
  }

  const UntrustedFolder& card_;
  const Settings& now_;
  CardResult found_;
};

}  // namespace

CardResult read_card(const UntrustedFolder& card, const Settings& now) {
  return Reader(card, now).read();
}

namespace {

using host::Level;
using Done = std::expected<void, std::string>;

constexpr mode_t kFolderOfOurs = 0700;

/// Gives a file that root made to the owner of its directory. Before systemd starts aditd, it checks only the
/// owner of the directory itself (systemd.exec(5), StateDirectory=).
Done give_to_owner(UntrustedFolder& folder, const std::string& path) {
  struct stat owner{};
  if (stat(folder.path_by_descriptor().c_str(), &owner) == 0 &&
      lchown(path.c_str(), owner.st_uid, owner.st_gid) == 0) {
    return {};
  }
  return std::unexpected(host::path_error(path, errno));
}

/// Writes a file of aditd, which makes the copy of it. aditd owns the directory, so its path is not trusted.
Done put(UntrustedFolder& folder, const std::string& name, const std::string& text) {
  ADIT_TRY(folder.remove(name + host::kCopy));
  const std::string path = folder.path_by_descriptor() + '/' + name;
  ADIT_TRY(host::write_file(path, text, host::kOursAlone));
  return give_to_owner(folder, path);
}

/// Creates the directory with the mode that systemd would use. systemd gives it to aditd.
std::expected<UntrustedFolder, std::string> open_state(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  std::error_code error;
  std::filesystem::create_directories(parent.parent_path(), error);
  for (const std::string& folder : {parent.string(), path}) {
    if (mkdir(folder.c_str(), kFolderOfOurs) != 0 && errno != EEXIST) {
      return std::unexpected(host::path_error(folder, errno));
    }
  }
  return UntrustedFolder::open(path);
}

/// `lasting`: the state survives a boot.
std::string result_text(const CardResult& found, bool lasting) {
  std::string text;
  if (!found.errors.empty()) {
    text = "Adit accepted no file. Correct these errors and restart Adit.\n";
    for (const std::string& error : found.errors) text += error + '\n';
  } else {
    const char* of_token = lasting ? ": accepted, and removed from here\n" : ": accepted\n";
    if (!found.brought.nothing()) {
      text = lasting ? "Adit accepted these files:\n"
                     : "Adit cannot store these files because its state partition is unusable. It reads them "
                       "at each boot:\n";
    }
    if (found.brought.settings) text += icd::sentence("adit/", kCardSettings, ": accepted\n");
    if (found.brought.numbers) text += icd::sentence("adit/", kCardNetwork, ": accepted\n");
    for (const auto& [file, token] : found.brought.tokens) {
      text += icd::sentence("adit/", kCardSecrets, "/", file, of_token);
    }
  }
  for (const std::string& name : found.left_alone) {
    text += icd::sentence("adit/", host::escape(name), ": ignored; Adit reads ", kCardSettings, ", ",
                          kCardNetwork, " and ", kCardSecrets, "/*", settings::kTokenEnding, "\n");
  }
  return text;
}

/// Writes only a changed text, because a card wears out.
Done write_result(UntrustedFolder& card, const std::string& text) {
  const auto told = card.read(kTakenText);
  if (told && *told == text) return {};
  return host::write_file(card.path_by_descriptor() + '/' + kTakenText, text, host::kOursAlone);
}

void rename_file(UntrustedFolder& folder, const std::string& name) {
  const std::string path = folder.path_by_descriptor() + '/' + name, taken = path + kTakenEnding;
  if (rename(path.c_str(), taken.c_str()) == 0) return;
  // If a directory has that name, removes it. Otherwise every start would accept the file again.
  if (folder.remove(name + kTakenEnding) && rename(path.c_str(), taken.c_str()) == 0) return;
  host::log(Level::Warning, "cannot rename an accepted file",
            {{"file", name}, {"why", std::strerror(errno)}});
}

/// Wipes accepted tokens, because the card can be read elsewhere. Each token is renamed first, so that a
/// start after an interrupted wipe finds it here.
void wipe_taken(UntrustedFolder& card) {
  const auto stays = [](const std::string& why) {
    host::log(Level::Warning, "an accepted token may still be on the card", {{"why", why}});
  };
  auto secrets = card.folder(kCardSecrets);
  if (!secrets) return stays(secrets.error());
  if (!*secrets) return;
  const auto names = (*secrets)->names();
  if (!names) return stays(names.error());
  for (const std::string& name : *names) {
    if (name.ends_with(kTakenEnding) && !(*secrets)->wipe(name)) stays("cannot wipe " + name);
  }
}

/// Renames the settings last. Without them, the next start could not accept the remaining files unchanged.
void rename_accepted(UntrustedFolder& card, const CardContents& brought) {
  if (auto secrets = card.folder(kCardSecrets); secrets && *secrets) {
    for (const auto& [file, token] : brought.tokens) rename_file(**secrets, file);
  }
  wipe_taken(card);
  if (brought.numbers) rename_file(card, kCardNetwork);
  if (brought.settings) rename_file(card, kCardSettings);
  const loop::FileDescriptor folder(
      open(card.path_by_descriptor().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder || syncfs(folder.get()) != 0) host::log(Level::Warning, "cannot sync the card");
}

}  // namespace

Done Import::run() {
  auto card = UntrustedFolder::open(options_.card);
  if (!card) {
    host::log(Level::Debug, "no directory adit on the card", {{"why", card.error()}});
    return {};
  }
  wipe_taken(*card);
  const auto now = current_settings();
  if (!now) {
    const std::string why = "cannot read the settings in use: " + now.error();
    (void)write_result(*card, "Adit accepted no file, because it " + why + '\n');  // also logged
    return std::unexpected(why);
  }
  const CardResult found = read_card(*card, *now);
  const bool lasting = ::access(options_.in_memory.c_str(), F_OK) != 0;
  const std::string said = result_text(found, lasting);
  if (said.empty()) return {};
  for (const std::string& error : found.errors)
    host::log(Level::Error, "file on the card rejected", {{"why", error}});
  // First, because every start would accept the files of a read-only card again.
  if (auto told = write_result(*card, said); !told) {
    return std::unexpected("cannot write to the card, so its files are ignored: " + told.error());
  }
  if (!found.errors.empty() || found.brought.nothing()) return {};
  if (auto saved = save(found.brought); !saved) {
    (void)write_result(*card, "Adit could not store these files: " + saved.error() + '\n');  // also logged
    return saved;
  }
  if (lasting) rename_accepted(*card, found.brought);
  host::log(Level::Notice, "files from the card accepted",
            {{"settings", found.brought.settings ? "yes" : "no"},
             {"network", found.brought.numbers ? "yes" : "no"},
             {"tokens", std::to_string(found.brought.tokens.size())}});
  return {};
}

std::expected<settings::Settings, std::string> Import::current_settings() const {
  std::optional<std::string> text;
  if (host::can_exist(options_.state)) {
    const auto state = ADIT_TRY(UntrustedFolder::open(options_.state));
    text = ADIT_TRY(state.read(settings::kSavedFile));
  }
  if (!text) text = ADIT_TRY(host::read_optional_file(options_.given));
  // As aditd reads it: a later Adit may have written it.
  auto saved = settings::parse_saved(text.value_or(""));
  return saved ? std::move(saved->settings) : settings::Settings{};
}

Done Import::save(const CardContents& brought) {
  auto state = ADIT_TRY(open_state(options_.state));
  ADIT_TRY(save_tokens(state, brought));
  if (brought.numbers) {
    std::error_code error;
    std::filesystem::create_directories(options_.network, error);
    const std::string file = options_.network + '/' + network::kConfirmedFile;
    ADIT_TRY(host::write_file(file, network::write_kept(*brought.numbers), host::kForAll));
  }
  return brought.settings ? save_settings(state, *brought.settings) : Done{};
}

Done Import::save_tokens(UntrustedFolder& state, const CardContents& brought) {
  if (brought.tokens.empty()) return {};
  const std::string path = state.path_by_descriptor() + '/' + settings::kSecretsFolder;
  if (mkdir(path.c_str(), kFolderOfOurs) != 0 && errno != EEXIST) {
    return std::unexpected(host::path_error(settings::kSecretsFolder, errno));
  }
  ADIT_TRY(give_to_owner(state, path));
  auto secrets = ADIT_TRY(state.folder(settings::kSecretsFolder));
  for (const auto& [file, token] : brought.tokens) {
    const std::string text = token.reveal() + "\n";
    auto saved = file == kCardCode ? put(state, access::kCodeFile, text) : put(*secrets, file, text);
    if (!saved) return saved;
  }
  return {};
}

/// Saves the settings on trial, as the page does. If aditd cannot start with them, it reverts them.
Done Import::save_settings(UntrustedFolder& state, const settings::Settings& settings) {
  const auto before = ADIT_TRY(state.read(settings::kFileBefore));
  if (!before) {
    const auto now = ADIT_TRY(state.read(settings::kSavedFile));
    ADIT_TRY(put(state, settings::kFileBefore, now.value_or(settings::kNoneBefore)));
  }
  return put(state, settings::kSavedFile, settings::file_of(settings));
}

}  // namespace adit::applier
