#pragma once

#include <expected>
#include <map>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"

namespace adit::host {

/// A descriptor that systemd handed over: a socket unit's, or one that the service had it keep.
struct Inherited {
  std::string name;  // FileDescriptorName= of the unit, or what store_descriptor() was told
  loop::FileDescriptor descriptor;
};

/// All of them (sd_listen_fds_with_names(3)), closed in programs that this one starts. None outside systemd,
/// and none when asked again.
std::expected<std::vector<Inherited>, std::string> inherited();

/// Has systemd keep a copy over restarts of the service (FDSTORE=1), until forget_descriptor(). `name`: at
/// most 255 visible ASCII characters, no colon. Nothing outside systemd.
void store_descriptor(const std::string& name, int descriptor);
/// All that were stored by that name.
void forget_descriptor(const std::string& name);

/// Ends the process in exec of its own program; the PID stays. The new start gets `sockets` as inherited(),
/// no other descriptor but 0 to 2, and the environment with `variables`. Blocked signals stay pending. Other
/// threads end. If exec fails, the process exits with status 1. `arguments`: main()'s.
[[noreturn]] void start_again(std::vector<Inherited> sockets, char* const* arguments,
                              std::map<std::string, std::string> variables);

}  // namespace adit::host
