#pragma once

#include <expected>
#include <optional>
#include <string>

#include "icd/bearer_token.hpp"

namespace adit::cli {

/// Where aditd.service has its tokens from.
inline constexpr const char* kSecrets = "/etc/adit/secrets";

/// What Adit is asked with, and where it was.
struct Token {
  icd::BearerToken token;
  std::string file;
};

/// The token in `file`; or, where that is empty, in the first of team.token and scoring.token in `secrets`
/// that can be read and holds one: perhaps none. An error names the file, never what is in it.
std::expected<std::optional<Token>, std::string> find_token(const std::string& file,
                                                            const std::string& secrets);

}  // namespace adit::cli
