#pragma once

#include <expected>
#include <string>

#include "loop/file_descriptor.hpp"

namespace adit::panel {

/// Sockets of packets in the file system (SOCK_SEQPACKET), none of which blocks. An error is errno's.
std::expected<loop::FileDescriptor, int> connected_to(const std::string& path);
/// For this user alone; what was at `path` is removed.
std::expected<loop::FileDescriptor, int> listening_at(const std::string& path);
/// The next who connected; EAGAIN: nobody.
std::expected<loop::FileDescriptor, int> accepted_at(const loop::FileDescriptor& listening);

}  // namespace adit::panel
