#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "access/role.hpp"
#include "icd/bearer_token.hpp"

namespace adit::access {

/// 256 bits that nobody can guess.
using Secret = std::array<std::uint8_t, 32>;

/// In 64 hexadecimal digits.
icd::BearerToken as_token(const Secret& secret);

/// Somebody who showed a password, and the browser that keeps showing the id since.
struct Session {
  std::uint64_t number = 0;  // what it is called by; tells nothing of `id`
  Role role = Role::Viewer;
  icd::BearerToken id, csrf;
  Instant made, seen;
  std::string address, agent;
};

/// Who comes to log in.
struct Caller {
  std::string address;
  std::string_view agent;  // User-Agent, anybody's text
};

/// Those who are logged in.
class Sessions {
 public:
  static constexpr std::chrono::hours kIdle{12}, kLongest{7 * 24};
  static constexpr std::size_t kMost = 64;  // at one more, the one that was idle for longest ends
  static constexpr std::size_t kLongestAgent = 160;  // the name of the browser comes after 80 to 110

  /// `id` and `csrf` have never been used before. The result is valid until the next call.
  const Session& begin(const Secret& id, const Secret& csrf, Role role, const Caller& caller, Instant now);
  /// The session whose id is presented, seen now, or null; valid until the next call.
  const Session* find(std::string_view id, Instant now);
  /// Whether that session has not ended; it is seen now.
  bool still(std::uint64_t number, Instant now);

  /// False: there is none.
  bool end(std::uint64_t number);
  /// Of a role, all but one (0: no exception).
  void end_all(Role role, std::uint64_t but);

  /// The newest first.
  std::vector<Session> all(Instant now);

 private:
  void forget_ended(Instant now);

  std::vector<Session> sessions_;  // in the order of their numbers
  std::uint64_t last_ = 0;
};

}  // namespace adit::access
