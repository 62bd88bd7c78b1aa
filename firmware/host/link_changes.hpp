#pragma once

#include "loop/file_descriptor.hpp"

namespace adit::host {

/// A socket that becomes readable whenever an interface comes, goes, or changes, its cable included
/// (rtnetlink(7), RTMGRP_LINK); none where the kernel gives none. It tells of a cable that comes at once, of
/// one that goes within a second.
loop::FileDescriptor link_changes();

/// The same, and whenever an interface's IPv4 addresses change (RTMGRP_IPV4_IFADDR).
loop::FileDescriptor link_and_address_changes();

/// Takes from it what it has told by now: who looks at the interfaces afterwards sees it. False: it is
/// broken, and will tell nothing more.
bool take_link_changes(const loop::FileDescriptor& changes);

}  // namespace adit::host
