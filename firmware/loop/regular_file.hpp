#pragma once

#include <fcntl.h>

#include <cerrno>
#include <cstddef>
#include <expected>
#include <string>

#include "loop/file_descriptor.hpp"

namespace adit::loop {

/// The errno of open_regular() for a FIFO, device, socket or directory.
inline constexpr int kNotRegular = EBADFD;
/// "No such file or directory"
std::string text_of(int error);

/// open(2) without blocking, because a FIFO may have no other end. Invalid, with errno, if open(2) fails or
/// the name is not that of a regular file.
FileDescriptor open_regular(const std::string& path, int flags, int folder = AT_FDCWD);

/// The bytes from where the file stands to its end, or the errno: EFBIG above `most` bytes.
std::expected<std::string, int> read_all(const FileDescriptor& file, std::size_t most);

}  // namespace adit::loop
