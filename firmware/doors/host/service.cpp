#include "host/service.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "access/password.hpp"
#include "host/files.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::host {
namespace {

/// systemd restricts credentials to the service by an ACL, which the mode bits do not show (systemd.exec(5),
/// LoadCredential=).
bool holds_credentials(const std::string& folder) {
  const char* credentials = std::getenv("CREDENTIALS_DIRECTORY");
  if (credentials == nullptr) return false;
  std::error_code unknown;
  return std::filesystem::equivalent(folder, credentials, unknown);
}

using Token = std::optional<icd::BearerToken>;

struct Fault {
  std::string why;
  bool is_unread = false;   // the file cannot be read
  bool is_damaged = false;  // it holds no token
};

enum class Place : std::uint8_t { Saved, Given, Credentials };

/// No token if the file is absent, or if a given file is empty. Errors never show the file's content.
std::expected<Token, Fault> read_one(const std::string& path, Place place) {
  const auto file = slurp(path);
  if (!file && file.error() == ENOENT) return Token();
  if (!file) return std::unexpected(Fault{path_error(path, file.error()), true});
  if (place != Place::Credentials && (file->status.st_mode & 077) != 0) {
    return std::unexpected(Fault{path + ": other users may read or write it; run: chmod 600 " + path});
  }
  const std::string checked = strip_checksum(file->text);
  const std::string_view text = icd::trim(checked);
  if (text.empty() && place != Place::Saved) return Token();
  auto token = icd::BearerToken::parse_file(checked);
  if (!token)
    return std::unexpected(
        Fault{path + ": expected one token of 1 to 256 visible ASCII characters", false, true});
  return token;
}

bool has_checksum(const std::string& path) {
  const auto file = slurp(path);
  return file && strip_checksum(file->text).size() < file->text.size();
}

/// The same, or of its copy if a saved file is damaged. Half a token is a token, too, without a checksum.
std::expected<Token, Fault> read_token(const std::string& path, Place place) {
  auto token = read_one(path, place);
  const bool may_be_damaged = token ? *token && !has_checksum(path) : token.error().is_damaged;
  if (place != Place::Saved || !may_be_damaged) return token;
  auto copy = read_one(path + kCopy, place);
  if (!copy && copy.error().is_unread) return copy;
  if (!copy || !*copy) return token;
  const bool is_half = token && (*copy)->reveal() != (*token)->reveal() &&
                       std::string_view((*copy)->reveal()).starts_with((*token)->reveal());
  if (token && !is_half) return token;
  log_use_of_copy(path);
  return copy;
}

}  // namespace

icd::Redaction Secrets::redaction() const {
  std::vector<icd::BearerToken> all;
  all.reserve(tokens.size() + replaced.size() + 1);
  for (const auto& [name, token] : tokens) all.push_back(token);
  if (label_code) all.push_back(*label_code);
  all.insert(all.end(), replaced.begin(), replaced.end());
  return icd::Redaction(std::move(all));
}

std::map<std::string, std::string> Secrets::token_warnings() const {
  constexpr std::size_t kLength = 16;
  std::map<std::string, std::string> odd = damaged;
  for (const auto& [name, token] : tokens) {
    const std::size_t length = token.reveal().size();
    if (name == "team" || length == kLength) continue;  // the team's token may have any length
    odd.emplace(name,
                icd::sentence("the token ", name, " has ", length, length == 1 ? " character" : " characters",
                              "; the Command Post's tokens have ", kLength, " (ICD 4); is it complete?"));
  }
  return odd;
}

std::string token_mark(const std::string& saved, std::string_view name) {
  return (std::filesystem::path(saved) / "").parent_path().parent_path() /
         icd::sentence(name, ".token", kSavedMark);
}

std::expected<Secrets, std::string> read_secrets(const std::string& given, const std::string& saved,
                                                 std::span<const std::string> names) {
  const Place place = holds_credentials(given) ? Place::Credentials : Place::Given;
  Secrets secrets;
  for (const std::string& name : names) {
    const std::string file = saved + "/" + name + ".token";
    const std::string mark_file = token_mark(saved, name);
    auto token = read_token(file, Place::Saved);
    const bool is_saved = !token || *token;
    if (!is_saved) {
      const auto mark = slurp(mark_file);
      if (mark)
        secrets.damaged[name] =
            icd::sentence("the saved token ", name, " is lost; set it again: ", file, " is gone");
      else if (mark.error() != ENOENT)
        secrets.unread = path_error(mark_file, mark.error());
      if (mark || mark.error() != ENOENT) continue;
      token = read_token(given + "/" + name + ".token", place);
    }
    if (token && *token) secrets.tokens.emplace(name, std::move(**token));
    if (token) continue;
    if (token.error().is_unread) {
      secrets.unread = std::move(token.error().why);
    } else if (is_saved) {
      secrets.damaged[name] =
          icd::sentence("the saved token ", name, " is damaged; set it again: ", token.error().why);
    } else {
      return std::unexpected(std::move(token.error().why));
    }
  }
  for (const std::string& file : {saved + '/' + kReplacedFile, saved + '/' + kReplacedFile + kCopy}) {
    const auto replaced = slurp(file);
    if (!replaced && replaced.error() != ENOENT) secrets.unread = path_error(file, replaced.error());
    const std::string lines = replaced ? strip_checksum(replaced->text) : "";
    for (std::string_view rest = lines; !rest.empty();) {
      if (auto token = icd::BearerToken::parse(icd::cut(rest, '\n'))) secrets.replaced.push_back(*token);
    }
    if (replaced && lines.size() < replaced->text.size()) break;  // its checksum is right
  }
  auto label = read_token(given + "/label.code", place);
  if (!label && !label.error().is_unread) return std::unexpected(std::move(label.error().why));
  if (!label) {
    secrets.unread = std::move(label.error().why);
  } else if (*label && !access::is_code((*label)->reveal())) {
    return std::unexpected(given + "/label.code: expected 8 digits");
  } else {
    secrets.label_code = std::move(*label);
  }
  return secrets;
}

}  // namespace adit::host
