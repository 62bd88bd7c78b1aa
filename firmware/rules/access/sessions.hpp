#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "access/role.hpp"
#include "icd/bearer_token.hpp"

namespace adit::access {

/// 256 random bits.
using Secret = std::array<std::uint8_t, 32>;

/// As 64 hexadecimal digits.
icd::BearerToken to_token(const Secret& secret);

/// A login. The browser shows `id` with each request.
struct Session {
  std::uint64_t number = 0;  // its public name; reveals nothing of `id`
  Role role = Role::Viewer;
  icd::BearerToken id, csrf;
  Instant made, seen;
  std::string address, agent;
};

/// The client that logs in.
struct Caller {
  std::string address;
  std::string_view agent;  // User-Agent, arbitrary text
};

class Sessions {
 public:
  static constexpr std::chrono::hours kIdle{12}, kLongest{7 * 24};
  /// Beyond it, begin() ends the viewer idle for longest, or an operator if there is no viewer.
  static constexpr std::size_t kMost = 64;
  static constexpr std::size_t kLongestAgent = 160;  // the browser's name starts at 80 to 110

  /// `changed`, if given, is called after each login and when a session is ended; not when one expires.
  explicit Sessions(std::function<void()> changed = {}) : changed_(std::move(changed)) {}

  /// Restores sessions, except expired ones and those with times after `now`. `last`: the last number in use.
  void restore(std::vector<Session> sessions, std::uint64_t last, Instant now);
  std::uint64_t last() const { return last_; }
  const std::vector<Session>& entries() const { return sessions_; }

  /// `id` and `csrf` must be new. The result is valid until the next call.
  const Session& begin(const Secret& id, const Secret& csrf, Role role, const Caller& caller, Instant now);
  /// The session with this id, or null. Marks it as seen now. The result is valid until the next call.
  const Session* find(std::string_view id, Instant now);
  /// True if the session has not ended. Marks it as seen now.
  bool touch(std::uint64_t number, Instant now);

  /// False if there is no such session.
  bool end(std::uint64_t number);
  /// Ends the role's sessions except number `but` (0: all).
  void end_all(Role role, std::uint64_t but);

  /// Newest first.
  std::vector<Session> all(Instant now);

 private:
  void forget_ended(Instant now);
  void notify_changed() const {
    if (changed_) changed_();
  }

  std::function<void()> changed_;
  std::vector<Session> sessions_;  // in order of number
  std::uint64_t last_ = 0;
};

/// Sessions as saved across a process restart. Times are monotonic, so they are valid within one boot only.
struct KeptSessions {
  std::string boot;  // identifies the boot; "": not known
  std::uint64_t last = 0;
  std::vector<Session> sessions;  // in order of number
};

/// The text of the file. It contains secrets.
std::string write_sessions(const KeptSessions& kept);
/// An error names its cause and contains no secret.
std::expected<KeptSessions, std::string> read_sessions(std::string_view json);

}  // namespace adit::access
