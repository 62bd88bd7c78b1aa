#pragma once

#include <memory>
#include <string>
#include <vector>

#include "alarms/acknowledged.hpp"
#include "loop/workers.hpp"

namespace adit::admin {

/// Which alarms are acknowledged, kept in a file for aditd alone, so that they stay so when the service ends.
/// A damaged or unreadable file is logged, and no alarm counts as acknowledged: the light blinks. An
/// unreadable file stays as it is until the next start.
class AcknowledgedFile {
 public:
  static constexpr const char* kFile = "acknowledged.json";  // in the state folder

  /// `writer` outlives it.
  AcknowledgedFile(const std::string& state_folder, loop::Writer& writer);

  std::vector<alarms::Acknowledged> read();
  /// Has them written where they are others than those of before; nobody waits for it.
  void keep(std::vector<alarms::Acknowledged> all);

 private:
  std::string file_, unread_;
  loop::Writer& writer_;
  std::vector<alarms::Acknowledged> kept_;
  std::shared_ptr<bool> failed_ = std::make_shared<bool>(false);  // the writer's
};

}  // namespace adit::admin
