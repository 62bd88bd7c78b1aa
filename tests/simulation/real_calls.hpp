#pragma once

#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

#include <span>

/// The kernel's file calls themselves, below those of libc that posix.cpp stands in for. They set errno.
namespace adit::simulation::real {

inline int open(int folder, const char* path, int flags, mode_t mode) {
  return static_cast<int>(::syscall(SYS_openat, folder, path, flags, mode));
}
inline ssize_t write(int fd, const void* bytes, std::size_t size) {
  return ::syscall(SYS_write, fd, bytes, size);
}
inline ssize_t write_at(int fd, const void* bytes, std::size_t size, off_t at) {
  return ::syscall(SYS_pwrite64, fd, bytes, size, at);
}
inline int truncate(int fd, off_t size) {
  return static_cast<int>(::syscall(SYS_ftruncate, fd, size));
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
