#pragma once

#include <expected>
#include <string>

namespace adit::rehearsal {

/// The tokens that the two endpoints know the team by.
struct Secrets {
  std::string scoring;
  std::string mapping;
};

/// `scoring.token` and `mapping.token` in `folder`; white space around a token is cut. An error names the
/// file, never what is in it.
std::expected<Secrets, std::string> read_secrets(const std::string& folder);

}  // namespace adit::rehearsal
