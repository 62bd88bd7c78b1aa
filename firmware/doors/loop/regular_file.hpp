#pragma once

#include <fcntl.h>

#include <cerrno>
#include <cstddef>
#include <expected>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"

namespace adit::loop {

/// The errno of open_regular() for a FIFO, device, socket or directory.
inline constexpr int kNotRegular = EBADFD;
/// The text of an errno of open_regular(): "No such file or directory".
std::string text_of(int error);

/// Opens a regular file by open(2), without blocking on a FIFO. If that fails or `path` is not a regular
/// file, the result is empty and errno is set. `folder`: a directory's descriptor, as in openat(2).
FileDescriptor open_regular(const std::string& path, int flags, int folder = AT_FDCWD);

/// Reads from the file's position to its end, at most `most` bytes. Returns the bytes or an errno.
std::expected<std::string, int> read_first(const FileDescriptor& file, std::size_t most);
/// Reads from the file's position to its end. Returns the bytes or an errno: EFBIG above `most` bytes.
std::expected<std::string, int> read_all(const FileDescriptor& file, std::size_t most);

/// Writes all of `bytes` at `offset` of a file. A short write goes on at its place. 0, or the errno, which
/// errno has then, too.
int write_all(int file, std::string_view bytes, std::size_t offset);

}  // namespace adit::loop
