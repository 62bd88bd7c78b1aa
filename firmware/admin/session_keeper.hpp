#pragma once

#include <string>

#include "access/sessions.hpp"

namespace adit::admin {

/// Those who are logged in, kept in a file for aditd alone, so that they stay so when the service ends, also
/// suddenly. A start of the machine forgets them. What is wrong with the file is logged, and costs no more
/// than a login. An unreadable file stays as it is until the next start.
class SessionKeeper {
 public:
  static constexpr const char* kFile = "sessions.json";  // in the runtime folder

  /// `now`: of the monotonic clock.
  SessionKeeper(std::string file, access::Instant now);

  access::Sessions& sessions() { return sessions_; }
  /// Writes down when each was seen last. Logging in and out is written at once.
  void keep();

 private:
  std::string file_, boot_, unread_;
  access::Sessions sessions_;
  bool failed_ = false;
};

}  // namespace adit::admin
