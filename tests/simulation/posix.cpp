// Replaces the calls of libc that read or change files. In ELF, a program's symbols come before a
// library's, so the calls of libstdc++ go to the simulated disk too. Calls outside the box's directory go
// straight to the kernel. The C++ names differ from libc's, because libc's headers declare more about
// theirs than is needed.
#include <dirent.h>
#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/uio.h>

#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "simulation/disk.hpp"
#include "simulation/real_calls.hpp"

namespace {

using adit::simulation::Disk;
using Call = adit::simulation::CallFaults::Call;
namespace real = adit::simulation::real;

int open_at(int folder, const char* path, int flags, mode_t mode) {
  if (Disk* const disk = Disk::of(folder, path)) return disk->open(folder, path, flags, mode);
  return real::open(folder, path, flags, mode);
}

int make_unique(char* path, int ending, int flags) {
  Disk* const disk = Disk::of(AT_FDCWD, path);
  char* const letters = path + std::strlen(path) - ending - 6;
  if (disk == nullptr) {
    const auto next = reinterpret_cast<int (*)(char*, int, int)>(::dlsym(RTLD_NEXT, "mkostemps"));
    return next(path, ending, flags);
  }
  std::memcpy(letters, disk->unique().data(), 6);
  return disk->open(AT_FDCWD, path, flags | O_RDWR | O_CREAT | O_EXCL, 0600);
}

ssize_t write_to(int fd, const void* bytes, std::size_t size, std::optional<off_t> at) {
  Disk* const disk = Disk::of(fd);
  const std::span all(static_cast<const char*>(bytes), size);
  if (disk != nullptr && size > 0) return disk->write(fd, all, at);
  return at ? real::write_at(fd, all, *at) : real::write(fd, bytes, size);
}

ssize_t read_from(int fd, void* to, std::size_t size, std::optional<off_t> at) {
  if (Disk* const disk = Disk::of(fd)) return disk->read(fd, to, size, at);
  return at ? real::read_at(fd, to, size, *at) : real::read(fd, to, size);
}

int status_of(int folder, const char* path, struct stat* found, int flags) {
  Disk* const disk = Disk::of(folder, path);
  if (disk != nullptr && disk->fails(Call::Status, folder, path) != 0) return -1;
  return real::status(folder, path, found, flags);
}

/// Whether a fault hides a part of the open directory's entries.
bool is_unlisted(int fd) {
  Disk* const disk = Disk::of(fd);
  return disk != nullptr && disk->fails(Call::List, fd) != 0;
}

std::FILE* open_stream(const char* path, const char* mode) {
  Disk* const disk = std::strpbrk(mode, "wa+") != nullptr ? Disk::of(AT_FDCWD, path) : nullptr;
  if (disk == nullptr) {
    const auto next = reinterpret_cast<std::FILE* (*)(const char*, const char*)>(::dlsym(RTLD_NEXT, "fopen"));
    return next(path, mode);
  }
  const int how = mode[0] == 'r' ? 0 : O_CREAT | (mode[0] == 'w' ? O_TRUNC : O_APPEND);
  const int fd = disk->open(AT_FDCWD, path, how | O_RDWR | O_CLOEXEC, 0666);
  return fd < 0 ? nullptr : ::fdopen(fd, mode);
}

void tell_space(std::uint64_t room, struct statvfs* space) {
  space->f_bsize = space->f_frsize = 4096;
  space->f_blocks = Disk::kRoom / 4096;
  space->f_bfree = space->f_bavail = room / 4096;
}

int space_of(const char* path, struct statvfs* space) {
  const auto next = reinterpret_cast<int (*)(const char*, struct statvfs*)>(::dlsym(RTLD_NEXT, "statvfs"));
  const int result = next(path, space);
  Disk* const disk = Disk::of(AT_FDCWD, path);
  if (result == 0 && disk != nullptr) tell_space(disk->room(AT_FDCWD, path), space);
  return result;
}

int space_of(int fd, struct statvfs* space) {
  const auto next = reinterpret_cast<int (*)(int, struct statvfs*)>(::dlsym(RTLD_NEXT, "fstatvfs"));
  const int result = next(fd, space);
  Disk* const disk = Disk::of(fd);
  if (result == 0 && disk != nullptr) tell_space(disk->room(fd), space);
  return result;
}

mode_t mode_in(int flags, std::va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl50-cpp,cert-dcl51-cpp)
#define ADIT_STANDS_FOR(name) __asm__(name) __attribute__((visibility("default"), used))

extern "C" {

int adit_open(const char* path, int flags, ...) ADIT_STANDS_FOR("open");
int adit_open64(const char* path, int flags, ...) ADIT_STANDS_FOR("open64");
int adit_openat(int folder, const char* path, int flags, ...) ADIT_STANDS_FOR("openat");
int adit_openat64(int folder, const char* path, int flags, ...) ADIT_STANDS_FOR("openat64");
int adit_open_2(const char* path, int flags) ADIT_STANDS_FOR("__open_2");
int adit_open64_2(const char* path, int flags) ADIT_STANDS_FOR("__open64_2");
int adit_creat(const char* path, mode_t mode) ADIT_STANDS_FOR("creat");
int adit_mkostemp(char* path, int flags) ADIT_STANDS_FOR("mkostemp");
int adit_mkostemps(char* path, int ending, int flags) ADIT_STANDS_FOR("mkostemps");
int adit_mkstemp(char* path) ADIT_STANDS_FOR("mkstemp");
char* adit_mkdtemp(char* path) ADIT_STANDS_FOR("mkdtemp");
std::FILE* adit_fopen(const char* path, const char* mode) ADIT_STANDS_FOR("fopen");
std::FILE* adit_fopen64(const char* path, const char* mode) ADIT_STANDS_FOR("fopen64");
ssize_t adit_write(int fd, const void* bytes, std::size_t size) ADIT_STANDS_FOR("write");
ssize_t adit_pwrite(int fd, const void* bytes, std::size_t size, off_t at) ADIT_STANDS_FOR("pwrite");
ssize_t adit_pwrite64(int fd, const void* bytes, std::size_t size, off_t at) ADIT_STANDS_FOR("pwrite64");
ssize_t adit_writev(int fd, const iovec* pieces, int count) ADIT_STANDS_FOR("writev");
ssize_t adit_read(int fd, void* to, std::size_t size) ADIT_STANDS_FOR("read");
ssize_t adit_pread(int fd, void* to, std::size_t size, off_t at) ADIT_STANDS_FOR("pread");
ssize_t adit_pread64(int fd, void* to, std::size_t size, off_t at) ADIT_STANDS_FOR("pread64");
void* adit_mmap(void* at, std::size_t size, int access, int flags, int fd, off_t from)
    ADIT_STANDS_FOR("mmap");
void* adit_mmap64(void* at, std::size_t size, int access, int flags, int fd, off_t from)
    ADIT_STANDS_FOR("mmap64");
int adit_stat(const char* path, struct stat* found) ADIT_STANDS_FOR("stat");
int adit_lstat(const char* path, struct stat* found) ADIT_STANDS_FOR("lstat");
int adit_fstatat(int folder, const char* path, struct stat* found, int flags) ADIT_STANDS_FOR("fstatat");
int adit_fstat(int fd, struct stat* found) ADIT_STANDS_FOR("fstat");
int adit_fstat64(int fd, struct stat* found) ADIT_STANDS_FOR("fstat64");
DIR* adit_opendir(const char* path) ADIT_STANDS_FOR("opendir");
DIR* adit_fdopendir(int fd) ADIT_STANDS_FOR("fdopendir");
dirent* adit_readdir(DIR* folder) ADIT_STANDS_FOR("readdir");
int adit_ftruncate(int fd, off_t size) ADIT_STANDS_FOR("ftruncate");
int adit_ftruncate64(int fd, off_t size) ADIT_STANDS_FOR("ftruncate64");
int adit_truncate(const char* path, off_t size) ADIT_STANDS_FOR("truncate");
int adit_fallocate(int fd, int mode, off_t at, off_t size) ADIT_STANDS_FOR("fallocate");
int adit_posix_fallocate(int fd, off_t at, off_t size) ADIT_STANDS_FOR("posix_fallocate");
int adit_fsync(int fd) ADIT_STANDS_FOR("fsync");
int adit_fdatasync(int fd) ADIT_STANDS_FOR("fdatasync");
int adit_rename(const char* from, const char* to) ADIT_STANDS_FOR("rename");
int adit_renameat(int from_folder, const char* from, int to_folder, const char* to)
    ADIT_STANDS_FOR("renameat");
int adit_unlink(const char* path) ADIT_STANDS_FOR("unlink");
int adit_unlinkat(int folder, const char* path, int flags) ADIT_STANDS_FOR("unlinkat");
int adit_remove(const char* path) ADIT_STANDS_FOR("remove");
int adit_rmdir(const char* path) ADIT_STANDS_FOR("rmdir");
int adit_mkdir(const char* path, mode_t mode) ADIT_STANDS_FOR("mkdir");
int adit_mkdirat(int folder, const char* path, mode_t mode) ADIT_STANDS_FOR("mkdirat");
int adit_linkat(int from_folder, const char* from, int to_folder, const char* to, int flags)
    ADIT_STANDS_FOR("linkat");
ssize_t adit_getrandom(void* bytes, std::size_t size, unsigned flags) ADIT_STANDS_FOR("getrandom");
int adit_chmod(const char* path, mode_t mode) ADIT_STANDS_FOR("chmod");
int adit_statvfs(const char* path, struct statvfs* space) ADIT_STANDS_FOR("statvfs");
int adit_fstatvfs(int fd, struct statvfs* space) ADIT_STANDS_FOR("fstatvfs");
int adit_close(int fd) ADIT_STANDS_FOR("close");

int adit_open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_at(AT_FDCWD, path, flags, mode);
}
int adit_open64(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_at(AT_FDCWD, path, flags, mode);
}
int adit_openat(int folder, const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_at(folder, path, flags, mode);
}
int adit_openat64(int folder, const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_at(folder, path, flags, mode);
}
int adit_open_2(const char* path, int flags) {
  return open_at(AT_FDCWD, path, flags, 0);
}
int adit_open64_2(const char* path, int flags) {
  return open_at(AT_FDCWD, path, flags, 0);
}
int adit_creat(const char* path, mode_t mode) {
  return open_at(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}

int adit_mkostemp(char* path, int flags) {
  return make_unique(path, 0, flags);
}
int adit_mkostemps(char* path, int ending, int flags) {
  return make_unique(path, ending, flags);
}
int adit_mkstemp(char* path) {
  return make_unique(path, 0, 0);
}
char* adit_mkdtemp(char* path) {
  Disk* const disk = Disk::of(AT_FDCWD, path);
  if (disk == nullptr) return reinterpret_cast<char* (*)(char*)>(::dlsym(RTLD_NEXT, "mkdtemp"))(path);
  std::memcpy(path + std::strlen(path) - 6, disk->unique().data(), 6);
  return disk->make_folder(AT_FDCWD, path, 0700) == 0 ? path : nullptr;
}

std::FILE* adit_fopen(const char* path, const char* mode) {
  return open_stream(path, mode);
}
std::FILE* adit_fopen64(const char* path, const char* mode) {
  return open_stream(path, mode);
}

ssize_t adit_write(int fd, const void* bytes, std::size_t size) {
  return write_to(fd, bytes, size, std::nullopt);
}
ssize_t adit_pwrite(int fd, const void* bytes, std::size_t size, off_t at) {
  return write_to(fd, bytes, size, at);
}
ssize_t adit_pwrite64(int fd, const void* bytes, std::size_t size, off_t at) {
  return write_to(fd, bytes, size, at);
}
ssize_t adit_writev(int fd, const iovec* pieces, int count) {
  if (Disk::of(fd) == nullptr) return ::syscall(SYS_writev, fd, pieces, count);
  std::string bytes;
  for (int i = 0; i < count; ++i)
    bytes.append(static_cast<const char*>(pieces[i].iov_base), pieces[i].iov_len);
  return write_to(fd, bytes.data(), bytes.size(), std::nullopt);
}

ssize_t adit_read(int fd, void* to, std::size_t size) {
  return read_from(fd, to, size, std::nullopt);
}
ssize_t adit_pread(int fd, void* to, std::size_t size, off_t at) {
  return read_from(fd, to, size, at);
}
ssize_t adit_pread64(int fd, void* to, std::size_t size, off_t at) {
  return read_from(fd, to, size, at);
}
void* adit_mmap(void* at, std::size_t size, int access, int flags, int fd, off_t from) {
  Disk* const disk = fd < 0 ? nullptr : Disk::of(fd);
  if (disk != nullptr && disk->fails(Call::Map, fd) != 0) return MAP_FAILED;
  return reinterpret_cast<void*>(::syscall(SYS_mmap, at, size, access, flags, fd, from));
}
void* adit_mmap64(void* at, std::size_t size, int access, int flags, int fd, off_t from) {
  return adit_mmap(at, size, access, flags, fd, from);
}

int adit_stat(const char* path, struct stat* found) {
  return status_of(AT_FDCWD, path, found, 0);
}
int adit_lstat(const char* path, struct stat* found) {
  return status_of(AT_FDCWD, path, found, AT_SYMLINK_NOFOLLOW);
}
int adit_fstatat(int folder, const char* path, struct stat* found, int flags) {
  return status_of(folder, path, found, flags);
}
int adit_fstat(int fd, struct stat* found) {
  Disk* const disk = Disk::of(fd);
  return disk != nullptr && disk->fails(Call::Status, fd) != 0 ? -1 : real::status(fd, found);
}
int adit_fstat64(int fd, struct stat* found) {
  return adit_fstat(fd, found);
}

DIR* adit_opendir(const char* path) {
  const int fd = open_at(AT_FDCWD, path, O_RDONLY | O_DIRECTORY | O_CLOEXEC, 0);
  if (fd < 0) return nullptr;
  DIR* const folder = adit_fdopendir(fd);
  const int error = errno;
  if (folder == nullptr) adit_close(fd);
  errno = error;
  return folder;
}
DIR* adit_fdopendir(int fd) {
  static const auto next = reinterpret_cast<DIR* (*)(int)>(::dlsym(RTLD_NEXT, "fdopendir"));
  return is_unlisted(fd) ? nullptr : next(fd);
}
dirent* adit_readdir(DIR* folder) {
  static const auto next = reinterpret_cast<dirent* (*)(DIR*)>(::dlsym(RTLD_NEXT, "readdir"));
  return is_unlisted(::dirfd(folder)) ? nullptr : next(folder);
}

int adit_ftruncate(int fd, off_t size) {
  Disk* const disk = Disk::of(fd);
  return disk != nullptr ? disk->truncate(fd, size) : real::truncate(fd, size);
}
int adit_ftruncate64(int fd, off_t size) {
  return adit_ftruncate(fd, size);
}
int adit_truncate(const char* path, off_t size) {
  const int fd = open_at(AT_FDCWD, path, O_WRONLY | O_CLOEXEC, 0);
  if (fd < 0) return -1;
  const int result = adit_ftruncate(fd, size), error = errno;
  adit_close(fd);
  errno = error;
  return result;
}
int adit_fallocate(int fd, int mode, off_t at, off_t size) {
  Disk* const disk = Disk::of(fd);
  return disk != nullptr ? disk->allocate(fd, mode, at, size) : real::allocate(fd, mode, at, size);
}
int adit_posix_fallocate(int fd, off_t at, off_t size) {
  return adit_fallocate(fd, 0, at, size) == 0 ? 0 : errno;
}

int adit_fsync(int fd) {
  Disk* const disk = Disk::of(fd);
  return disk != nullptr ? disk->sync(fd) : real::sync(fd);
}
int adit_fdatasync(int fd) {
  return adit_fsync(fd);
}

int adit_rename(const char* from, const char* to) {
  return adit_renameat(AT_FDCWD, from, AT_FDCWD, to);
}
int adit_renameat(int from_folder, const char* from, int to_folder, const char* to) {
  Disk* const disk = Disk::of(from_folder, from);
  return disk != nullptr ? disk->rename(from_folder, from, to_folder, to)
                         : real::rename(from_folder, from, to_folder, to);
}
int adit_unlinkat(int folder, const char* path, int flags) {
  Disk* const disk = Disk::of(folder, path);
  return disk != nullptr ? disk->unlink(folder, path, flags) : real::unlink(folder, path, flags);
}
int adit_unlink(const char* path) {
  return adit_unlinkat(AT_FDCWD, path, 0);
}
int adit_rmdir(const char* path) {
  return adit_unlinkat(AT_FDCWD, path, AT_REMOVEDIR);
}
int adit_remove(const char* path) {
  if (adit_unlink(path) == 0) return 0;
  return errno == EISDIR ? adit_rmdir(path) : -1;
}
int adit_mkdirat(int folder, const char* path, mode_t mode) {
  Disk* const disk = Disk::of(folder, path);
  return disk != nullptr ? disk->make_folder(folder, path, mode) : real::make_folder(folder, path, mode);
}
int adit_mkdir(const char* path, mode_t mode) {
  return adit_mkdirat(AT_FDCWD, path, mode);
}
int adit_linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  Disk* const disk = Disk::of(to_folder, to);
  return disk != nullptr ? disk->link(from_folder, from, to_folder, to)
                         : static_cast<int>(::syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}
ssize_t adit_getrandom(void* bytes, std::size_t size, unsigned flags) {
  return Disk::fill_random(bytes, size) ? static_cast<ssize_t>(size)
                                        : ::syscall(SYS_getrandom, bytes, size, flags);
}
int adit_chmod(const char* path, mode_t mode) {
  Disk* const disk = Disk::of(AT_FDCWD, path);
  if (disk != nullptr && disk->may_change(AT_FDCWD, path) != 0) return -1;
  return static_cast<int>(::syscall(SYS_fchmodat, AT_FDCWD, path, mode));
}
int adit_statvfs(const char* path, struct statvfs* space) {
  return space_of(path, space);
}
int adit_fstatvfs(int fd, struct statvfs* space) {
  return space_of(fd, space);
}
int adit_close(int fd) {
  Disk::forget(fd);
  return real::close(fd);
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,cert-dcl50-cpp,cert-dcl51-cpp)
