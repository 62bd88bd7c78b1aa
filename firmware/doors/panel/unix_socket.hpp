#pragma once

#include <expected>
#include <string>

#include "loop/file_descriptor.hpp"

namespace adit::panel {

/// Non-blocking packet sockets in the file system (SOCK_SEQPACKET). An error is errno's value.
std::expected<loop::FileDescriptor, int> connected_to(const std::string& path);
/// For this user only. Replaces a file at `path`.
std::expected<loop::FileDescriptor, int> listening_at(const std::string& path);
/// The next connection. EAGAIN: there is none.
std::expected<loop::FileDescriptor, int> accepted_at(const loop::FileDescriptor& listening);

}  // namespace adit::panel
