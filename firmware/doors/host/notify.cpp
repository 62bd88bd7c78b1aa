#include <systemd/sd-daemon.h>

#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

/// Escaped, because a newline in `status` would begin another assignment (sd_notify(3)).
std::string assignment(const std::string& status) {
  return "STATUS=" + escaped(without_secrets(status));
}

/// Sets systemd's watchdog interval.
void notify_watchdog(std::chrono::microseconds within) {
  sd_notify(0, ("WATCHDOG_USEC=" + std::to_string(within.count())).c_str());
}

}  // namespace

void notify_ready(const std::string& status) {
  sd_notify(0, ("READY=1\n" + assignment(status)).c_str());
  if (const auto within = watchdog_within()) notify_watchdog(*within);
}

void notify_status(const std::string& status) {
  sd_notify(0, assignment(status).c_str());
}

void notify_stopping() {
  sd_notify(0, "STOPPING=1");
}

void notify_starting_again() {
  if (watchdog_within()) notify_watchdog(kLongestStart);
}

void notify_alive() {
  sd_notify(0, "WATCHDOG=1");
}

std::optional<std::chrono::microseconds> watchdog_within() {
  std::uint64_t usec = 0;
  if (sd_watchdog_enabled(0, &usec) <= 0) return std::nullopt;
  return std::chrono::microseconds(usec);
}

}  // namespace adit::host
