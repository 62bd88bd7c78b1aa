#pragma once

#include <string>

#include "access/sessions.hpp"

namespace adit::admin {

/// Stores the sessions in a file that only aditd can read, across restarts and crashes. A boot ends all
/// sessions. A faulty file is logged, and users log in again. An unreadable file stays unchanged until the
/// next start.
class SessionKeeper {
 public:
  static constexpr const char* kFile = "sessions.json";  // in the runtime directory

  /// `now`: monotonic time.
  SessionKeeper(std::string file, access::Instant now);

  access::Sessions& sessions() { return sessions_; }
  /// Stores the last use of each session. Logins and logouts are stored at once.
  void keep();

 private:
  std::string file_, boot_, unread_;
  access::Sessions sessions_;
  bool failed_ = false;
};

}  // namespace adit::admin
