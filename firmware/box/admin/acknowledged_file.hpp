#pragma once

#include <memory>
#include <string>
#include <vector>

#include "alarms/acknowledged.hpp"
#include "loop/workers.hpp"

namespace adit::admin {

/// Stores the acknowledged alarms in a file that only aditd can read, across restarts. If the file is damaged
/// or unreadable, logs it and acknowledges no alarm, so the light blinks. An unreadable file stays unchanged
/// until the next start.
class AcknowledgedFile {
 public:
  static constexpr const char* kFile = "acknowledged.json";  // in the state directory

  /// `writer` must outlive this object.
  AcknowledgedFile(const std::string& state_folder, loop::Writer& writer);

  std::vector<alarms::Acknowledged> read();
  /// Stores a changed list in the writer thread, without waiting.
  void keep(std::vector<alarms::Acknowledged> all);

 private:
  std::string file_, unread_;
  loop::Writer& writer_;
  std::vector<alarms::Acknowledged> kept_;
  std::shared_ptr<bool> failed_ = std::make_shared<bool>(false);  // used by the writer thread
};

}  // namespace adit::admin
