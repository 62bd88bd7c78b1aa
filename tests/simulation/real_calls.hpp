#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstring>
#include <span>

/// The kernel's file calls, below the functions of libc that posix.cpp replaces. They set errno.
namespace adit::simulation::real {

inline int open(int folder, const char* path, int flags, mode_t mode) {
  return static_cast<int>(::syscall(SYS_openat, folder, path, flags, mode));
}
inline ssize_t write(int fd, const void* bytes, std::size_t size) {
  return ::syscall(SYS_write, fd, bytes, size);
}
inline int truncate(int fd, off_t size) {
  return static_cast<int>(::syscall(SYS_ftruncate, fd, size));
}
inline ssize_t read(int fd, void* bytes, std::size_t size) {
  return ::syscall(SYS_read, fd, bytes, size);
}
inline ssize_t read_at(int fd, void* bytes, std::size_t size, off_t at) {
  return ::syscall(SYS_pread64, fd, bytes, size, at);
}
inline int status(int fd, struct stat* found) {
  return static_cast<int>(::syscall(SYS_fstat, fd, found));
}
inline int status(int folder, const char* path, struct stat* found, int flags) {
  return static_cast<int>(::syscall(SYS_newfstatat, folder, path, found, flags));
}
/// Whether the bytes are pages of zeros beyond a file's end, which a hole can replace.
inline bool may_be_hole(int fd, std::span<const char> bytes, off_t at) {
  struct stat file{};
  return bytes.size() >= 4096 && bytes[0] == 0 && std::memcmp(&bytes[0], &bytes[1], bytes.size() - 1) == 0 &&
         status(fd, &file) == 0 && S_ISREG(file.st_mode) && file.st_size <= at;
}
/// Writes zeros as a hole, because a file of the ledger begins as 4 MiB of zeros, and a hole is quick to
/// make and to copy.
inline ssize_t write_at(int fd, std::span<const char> bytes, off_t at) {
  const auto size = static_cast<ssize_t>(bytes.size());
  if (may_be_hole(fd, bytes, at)) return truncate(fd, at + size) == 0 ? size : -1;
  return ::syscall(SYS_pwrite64, fd, bytes.data(), bytes.size(), at);
}
inline int allocate(int fd, int mode, off_t at, off_t size) {
  return static_cast<int>(::syscall(SYS_fallocate, fd, mode, at, size));
}
inline int sync(int fd) {
  return static_cast<int>(::syscall(SYS_fsync, fd));
}
inline int rename(int from_folder, const char* from, int to_folder, const char* to) {
  return static_cast<int>(::syscall(SYS_renameat2, from_folder, from, to_folder, to, 0));
}
inline int link(int from_folder, const char* from, int to_folder, const char* to) {
  return static_cast<int>(::syscall(SYS_linkat, from_folder, from, to_folder, to, 0));
}
inline int unlink(int folder, const char* path, int flags) {
  return static_cast<int>(::syscall(SYS_unlinkat, folder, path, flags));
}
inline int make_folder(int folder, const char* path, mode_t mode) {
  return static_cast<int>(::syscall(SYS_mkdirat, folder, path, mode));
}
inline int close(int fd) {
  return static_cast<int>(::syscall(SYS_close, fd));
}

}  // namespace adit::simulation::real
