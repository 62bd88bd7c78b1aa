#include "cli/token.hpp"

#include "host/service.hpp"

namespace adit::cli {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

}  // namespace

std::expected<Token, std::string> token_in_file(const std::string& file) {
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(text.error());
  auto token = icd::BearerToken::parse(trimmed(*text));
  if (!token) return std::unexpected(file + ": expected one token of 1 to 256 visible ASCII characters");
  return Token{std::move(*token), file};
}

std::expected<std::optional<Token>, std::string> find_token(const std::string& file,
                                                            std::span<const std::string> folders) {
  if (!file.empty()) return token_in_file(file);
  for (const char* name : {"/team.token", "/scoring.token"}) {
    for (const std::string& folder : folders) {
      const std::string path = folder + name;
      if (!host::may_exist(path)) continue;
      const auto text = host::read_file(path);
      if (!text)
        return std::unexpected(text.error() +
                               "; run adit as root, or name a token file by --token-file FILE");
      const bool is_saved = &folder == &folders.front();
      if (is_saved || !trimmed(*text).empty()) return token_in_file(path);
    }
  }
  return std::nullopt;
}

}  // namespace adit::cli
