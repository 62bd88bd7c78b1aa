#pragma once

#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "access/sessions.hpp"
#include "alarms/board.hpp"
#include "host/service.hpp"
#include "loop/workers.hpp"

namespace adit::admin {

/// Parses a file's text by `read`, or returns a new value if there is no file. An error names the file. If
/// the file cannot be read, sets `unread` to the error; the caller must then not replace the file.
template <class Read>
auto read_kept_file(const std::string& file, Read read, std::string& unread)
    -> decltype(read(std::string_view())) {
  if (!host::can_exist(file)) return {};
  auto kept = host::parse_kept(file, read);
  if (!kept) return std::unexpected(unread = kept.error());
  if (!*kept) return std::unexpected(file + ": " + kept->error());
  return *std::move(kept);
}

/// Stores the acknowledged alarms in a file for aditd alone, across restarts. If it is damaged or unreadable,
/// logs it and acknowledges no alarm, so the light blinks. An unreadable file stays until the next start.
class AcknowledgementFile {
 public:
  static constexpr const char* kFile = "acknowledged.json";  // in the state directory

  /// `writer` must outlive this object.
  AcknowledgementFile(const std::string& state_folder, loop::Writer& writer);

  std::vector<alarms::Acknowledgement> read();
  /// Stores a changed list in the writer thread, without waiting.
  void keep(std::vector<alarms::Acknowledgement> all);

 private:
  std::string file_, unread_;
  loop::Writer& writer_;
  std::vector<alarms::Acknowledgement> kept_;
  std::shared_ptr<bool> failed_ = std::make_shared<bool>(false);  // used by the writer thread
};

/// Stores the sessions in a file for aditd alone, across restarts and crashes. A boot ends all sessions. A
/// faulty file is logged, and users log in again. An unreadable file stays until the next start.
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
