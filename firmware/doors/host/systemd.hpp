#pragma once

#include <chrono>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"

namespace adit::host {

/// sd_notify(3): report readiness, stopping, and the status text ("STATUS="). Without effect outside systemd.
void notify_ready(const std::string& status);
void notify_status(const std::string& status);
void notify_stopping();
/// Announces a new process start (restart_process()). It may take the time of any start until notify_ready().
void notify_restarting();
void notify_alive();                                      // WATCHDOG=1
inline constexpr std::chrono::seconds kLongestStart{60};  // services/adit.service: TimeoutStartSec=

/// systemd's watchdog interval (WatchdogSec=), or std::nullopt without a watchdog.
std::optional<std::chrono::microseconds> watchdog_interval();

/// A descriptor from systemd: a unit's socket, or one stored by the service.
struct InheritedDescriptor {
  std::string name;  // FileDescriptorName= of the unit, or the name given to store_descriptor()
  loop::FileDescriptor descriptor;
};

/// All inherited descriptors (sd_listen_fds_with_names(3)), closed on exec. Empty outside systemd, and at a
/// second call.
std::expected<std::vector<InheritedDescriptor>, std::string> inherited_sockets();

/// Makes systemd store a copy across restarts of the service (FDSTORE=1), until forget_descriptor(). `name`:
/// at most 255 visible ASCII characters, no colon. Without effect outside systemd.
void store_descriptor(const std::string& name, int descriptor);
/// Removes all stored descriptors of that name.
void forget_descriptor(const std::string& name);

/// Replaces the process by a new start of its program (exec); the PID stays. The new start gets `sockets` as
/// inherited_sockets(), descriptors 0 to 2, and the environment with `variables`. Blocked signals stay
/// pending. Other threads end. If exec fails, the process exits with status 1. `arguments`: main()'s.
[[noreturn]] void restart_process(std::vector<InheritedDescriptor> sockets, char* const* arguments,
                                  std::map<std::string, std::string> variables);

}  // namespace adit::host
