#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "access/password.hpp"
#include "host/files.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

/// systemd keeps credentials readable for the service alone, by an ACL that the mode bits do not show
/// (systemd.exec(5), LoadCredential=).
bool holds_credentials(const std::string& folder) {
  const char* credentials = std::getenv("CREDENTIALS_DIRECTORY");
  if (credentials == nullptr) return false;
  std::error_code unknown;
  return std::filesystem::equivalent(folder, credentials, unknown);
}

std::string_view trimmed(std::string_view text) {
  static constexpr std::string_view kSpace = " \t\r\n";
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

using Token = std::optional<icd::BearerToken>;

/// Nothing where there is no such file, or nothing in it. No sentence shows what is in it.
std::expected<Token, std::string> read_token(const std::string& path, bool credential) {
  const auto file = slurp(path);
  if (!file && file.error() == ENOENT) return Token();
  if (!file) return std::unexpected(trouble(path, file.error()));
  if (!credential && (file->status.st_mode & 077) != 0) {
    return std::unexpected(path + ": others may read or write it; run: chmod 600 " + path);
  }
  const std::string_view text = trimmed(file->text);
  if (text.empty()) return Token();
  auto token = icd::BearerToken::parse(text);
  if (!token) return std::unexpected(path + ": expected one token of 1 to 256 visible ASCII characters");
  return token;
}

std::expected<Token, std::string> read_required_token(const std::string& path, bool credential) {
  auto token = read_token(path, credential);
  if (token && !*token) return std::unexpected(path + ": there is no token");
  return token;
}

}  // namespace

std::expected<Secrets, std::string> read_secrets(const std::string& folder) {
  const bool credentials = holds_credentials(folder);
  auto scoring = read_required_token(folder + "/scoring.token", credentials);
  if (!scoring) return std::unexpected(scoring.error());
  auto mapping = read_required_token(folder + "/mapping.token", credentials);
  if (!mapping) return std::unexpected(mapping.error());
  auto team = read_token(folder + "/team.token", credentials);
  if (!team) return std::unexpected(team.error());
  auto label = read_token(folder + "/label.code", credentials);
  if (!label) return std::unexpected(label.error());
  if (*label && !access::is_code((*label)->reveal())) {
    return std::unexpected(folder + "/label.code: expected 8 digits");
  }
  return Secrets{std::move(*scoring), std::move(*mapping), std::move(*team), std::move(*label)};
}

}  // namespace adit::host
