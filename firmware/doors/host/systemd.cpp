#include "host/systemd.hpp"

#include <fcntl.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "host/log.hpp"

namespace adit::host {
namespace {

/// Escaped, because a newline in `status` would begin another assignment (sd_notify(3)).
std::string assignment(const std::string& status) {
  return "STATUS=" + escape(strip_secrets(status));
}

/// Sets systemd's watchdog interval.
void notify_watchdog(std::chrono::microseconds within) {
  sd_notify(0, ("WATCHDOG_USEC=" + std::to_string(within.count())).c_str());
}

}  // namespace

void notify_ready(const std::string& status) {
  sd_notify(0, ("READY=1\n" + assignment(status)).c_str());
  if (const auto within = watchdog_interval()) notify_watchdog(*within);
}

void notify_status(const std::string& status) {
  sd_notify(0, assignment(status).c_str());
}

void notify_stopping() {
  sd_notify(0, "STOPPING=1");
}

void notify_restarting() {
  if (watchdog_interval()) notify_watchdog(kLongestStart);
}

void notify_alive() {
  sd_notify(0, "WATCHDOG=1");
}

std::optional<std::chrono::microseconds> watchdog_interval() {
  std::uint64_t usec = 0;
  if (sd_watchdog_enabled(0, &usec) <= 0) return std::nullopt;
  return std::chrono::microseconds(usec);
}

std::expected<std::vector<InheritedDescriptor>, std::string> inherited_sockets() {
  char** names = nullptr;
  const int count = sd_listen_fds_with_names(1, &names);
  if (count < 0) {
    return std::unexpected(std::string("reading the sockets from systemd: ") + std::strerror(-count));
  }
  std::vector<InheritedDescriptor> all;
  for (int i = 0; i < count; ++i) {
    const std::unique_ptr<char, decltype(&std::free)> name(names[i], &std::free);
    all.push_back({.name = name.get(), .descriptor = loop::FileDescriptor(SD_LISTEN_FDS_START + i)});
  }
  std::free(static_cast<void*>(names));
  return all;
}

void store_descriptor(const std::string& name, int descriptor) {
  sd_pid_notify_with_fds(0, 0, ("FDSTORE=1\nFDNAME=" + name).c_str(), &descriptor, 1);
}

void forget_descriptor(const std::string& name) {
  sd_notify(0, ("FDSTOREREMOVE=1\nFDNAME=" + name).c_str());
}

namespace {

/// Writes to stderr, because the log's descriptor may be closed.
void require_success(int result, const char* doing) {
  if (result >= 0) return;
  std::fprintf(stderr, "cannot start again: %s: %s\n", doing, std::strerror(errno));
  _exit(1);
}

}  // namespace

void restart_process(std::vector<InheritedDescriptor> sockets, char* const* arguments,
                     std::map<std::string, std::string> variables) {
  const int count = static_cast<int>(sockets.size());
  std::string names;
  require_success(close_range(SD_LISTEN_FDS_START, ~0U, CLOSE_RANGE_CLOEXEC), "closing descriptors");
  // Copies above all final places first, because a final place may be another socket's.
  for (InheritedDescriptor& each : sockets) {
    each.descriptor =
        loop::FileDescriptor(fcntl(each.descriptor.get(), F_DUPFD_CLOEXEC, SD_LISTEN_FDS_START + count));
    require_success(each.descriptor.get(), "copying a socket");
    names += (names.empty() ? "" : ":") + each.name;
  }
  for (int i = 0; i < count; ++i)
    require_success(dup2(sockets[static_cast<std::size_t>(i)].descriptor.get(), SD_LISTEN_FDS_START + i),
                    "passing a socket");
  if (count > 0) {  // sd_listen_fds() rejects 0
    variables["LISTEN_PID"] = std::to_string(getpid());
    variables["LISTEN_FDS"] = std::to_string(count);
    variables["LISTEN_FDNAMES"] = names;
  }
  for (const auto& [name, value] : variables) setenv(name.c_str(), value.c_str(), 1);
  require_success(execv("/proc/self/exe", arguments), "exec");
  std::abort();
}

}  // namespace adit::host
