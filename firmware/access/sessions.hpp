#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
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
  static constexpr std::size_t kMost =
      64;  // at one more, the viewer that was idle for longest ends, or else the operator
  static constexpr std::size_t kLongestAgent = 160;  // the name of the browser comes after 80 to 110

  /// `changed`, if given, is called whenever somebody logs in or a session is ended.
  explicit Sessions(std::function<void()> changed = {}) : changed_(std::move(changed)) {}

  /// Takes up those of an earlier start; none that has ended, or begins after `now`. `last`: the number that
  /// was given last.
  void restore(std::vector<Session> sessions, std::uint64_t last, Instant now);
  std::uint64_t last() const { return last_; }
  const std::vector<Session>& in_order() const { return sessions_; }

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
  void tell() const {
    if (changed_) changed_();
  }

  std::function<void()> changed_;
  std::vector<Session> sessions_;  // in the order of their numbers
  std::uint64_t last_ = 0;
};

}  // namespace adit::access
