#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>

#include "icd/bearer_token.hpp"

namespace adit::cli {

/// Directories of adit.service's given tokens and of its saved ones.
inline constexpr const char* kSecrets = "/etc/adit/secrets";
inline constexpr const char* kSavedSecrets = "/var/lib/adit/secrets";

/// A token and its file.
struct Token {
  icd::BearerToken token;
  std::string file;
};

/// Reads the token in a file. An error names the file, never its content.
std::expected<Token, std::string> token_in_file(const std::string& file);

/// The token in `file`. If `file` is "", the first of team.token and scoring.token in `folders`, each in the
/// first directory (the saved tokens) first; std::nullopt if there is none. An empty file is no token, except
/// in the first directory. An error names the file, never its content: the file cannot be read, or holds no
/// token.
std::expected<std::optional<Token>, std::string> find_token(const std::string& file,
                                                            std::span<const std::string> folders);

}  // namespace adit::cli
