#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>

#include "icd/bearer_token.hpp"

namespace adit::cli {

/// Where adit.service has its tokens from, and where it keeps those that were saved since.
inline constexpr const char* kSecrets = "/etc/adit/secrets";
inline constexpr const char* kSavedSecrets = "/var/lib/adit/secrets";

/// What Adit is asked with, and where it was.
struct Token {
  icd::BearerToken token;
  std::string file;
};

/// The one token in a file. An error names the file, never what is in it.
std::expected<Token, std::string> token_in_file(const std::string& file);

/// The token in `file`; or, if that is "", in the first of team.token and scoring.token in `folders`, each in
/// the first folder (the saved tokens) first; perhaps none. An empty file counts as none, except in the first
/// folder. An error names the file, never its content: the file cannot be read, or holds no token.
std::expected<std::optional<Token>, std::string> find_token(const std::string& file,
                                                            std::span<const std::string> folders);

}  // namespace adit::cli
