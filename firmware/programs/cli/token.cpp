#include "cli/token.hpp"

#include "host/service.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::cli {

std::expected<Token, std::string> token_in_file(const std::string& file) {
  const auto text = ADIT_TRY(host::read_file(file));
  auto token = icd::BearerToken::parse(icd::trimmed(text));
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
      if (is_saved || !icd::trimmed(*text).empty()) return token_in_file(path);
    }
  }
  return std::nullopt;
}

}  // namespace adit::cli
