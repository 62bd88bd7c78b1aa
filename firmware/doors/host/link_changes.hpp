#pragma once

#include <optional>
#include <string>

#include "loop/file_descriptor.hpp"

namespace adit::host {

/// As carrier() of service.hpp. `sys_class_net`: the kernel's list of interfaces.
std::optional<bool> carrier_in(const std::string& sys_class_net, const std::string& interface);

/// A socket that becomes readable when an interface comes, goes or changes, or its cable does (rtnetlink(7),
/// RTMGRP_LINK). Reports a plugged cable at once, a pulled one within a second. Empty if the kernel gives no
/// socket.
loop::FileDescriptor link_changes();

/// The same, also for changes of IPv4 addresses (RTMGRP_IPV4_IFADDR).
loop::FileDescriptor link_and_address_changes();

/// Clears the socket. Read the interfaces afterwards. False: the socket is broken and reports no more
/// changes.
bool take_link_changes(const loop::FileDescriptor& changes);

}  // namespace adit::host
