#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "access/sessions.hpp"

namespace adit::access {

/// Sessions as saved across a process restart. Times are monotonic, so they are valid within one boot only.
struct KeptSessions {
  std::string boot;  // identifies the boot; "": not known
  std::uint64_t last = 0;
  std::vector<Session> sessions;  // in order of number
};

/// The text of the file. It contains secrets.
std::string write_sessions(const KeptSessions& kept);
/// An error says what is wrong and contains no secret.
std::expected<KeptSessions, std::string> read_sessions(std::string_view json);

}  // namespace adit::access
