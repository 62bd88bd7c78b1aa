#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "access/sessions.hpp"

namespace adit::access {

/// Sessions as they are kept across an end of the service. Times are of the machine's monotonic clock, which
/// goes on from one start of the service to the next, but not over a start of the machine.
struct KeptSessions {
  std::string boot;  // names the start of the machine; "": nobody knows
  std::uint64_t last = 0;
  std::vector<Session> sessions;  // in the order of their numbers
};

/// The text of the file; holds what lets people in.
std::string write_sessions(const KeptSessions& kept);
/// An error says what is wrong and shows nothing of what is in it.
std::expected<KeptSessions, std::string> read_sessions(std::string_view json);

}  // namespace adit::access
