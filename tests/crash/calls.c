/* These stand before the C library's own, for aditd and for the libraries that it uses. A call that neither
   writes, syncs, sends nor receives is no fault point. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/sendfile.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "fault_points.h"
#include "unsynced.h"

static void* the_next(const char* name) {
  void* function = dlsym(RTLD_NEXT, name);
  if (function == NULL) abort();
  return function;
}

/* Declares `real`, the function of this name that would have been called. */
#define REAL(type, name, ...)       \
  static type (*real)(__VA_ARGS__); \
  if (real == NULL) *(void**)&real = the_next(#name)

static long long total(const struct iovec* pieces, size_t count) {
  long long sum = 0;
  for (size_t i = 0; i < count; ++i) sum += (long long)pieces[i].iov_len;
  return sum;
}

/* Files */

ssize_t pwrite64(int file, const void* data, size_t size, off64_t offset) {
  REAL(ssize_t, pwrite64, int, const void*, size_t, off64_t);
  struct Point point;
  if (!begin(&point, "pwrite64", file, (long long)size, offset)) return real(file, data, size, offset);
  remember_write(file, offset, size);
  return end(&point, real(file, data, size, offset));
}

ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  REAL(ssize_t, pwrite, int, const void*, size_t, off_t);
  struct Point point;
  if (!begin(&point, "pwrite", file, (long long)size, offset)) return real(file, data, size, offset);
  remember_write(file, offset, size);
  return end(&point, real(file, data, size, offset));
}

int ftruncate64(int file, off64_t length) {
  REAL(int, ftruncate64, int, off64_t);
  struct Point point;
  if (!begin(&point, "ftruncate64", file, length, 0)) return real(file, length);
  remember_truncation(file, length);
  return (int)end(&point, real(file, length));
}

int ftruncate(int file, off_t length) {
  REAL(int, ftruncate, int, off_t);
  struct Point point;
  if (!begin(&point, "ftruncate", file, length, 0)) return real(file, length);
  remember_truncation(file, length);
  return (int)end(&point, real(file, length));
}

static int flushed(const struct Point* point, int file, int result) {
  if (result == 0) forget_changes(file);
  return (int)end(point, result);
}

int fdatasync(int file) {
  REAL(int, fdatasync, int);
  struct Point point;
  if (!begin(&point, "fdatasync", file, 0, 0)) return real(file);
  return flushed(&point, file, real(file));
}

int fsync(int file) {
  REAL(int, fsync, int);
  struct Point point;
  if (!begin(&point, "fsync", file, 0, 0)) return real(file);
  return flushed(&point, file, real(file));
}

int unlink(const char* path) {
  REAL(int, unlink, const char*);
  struct Point point;
  if (!begin_path(&point, "unlink", path)) return real(path);
  return (int)end(&point, real(path));
}

int rename(const char* from, const char* to) {
  REAL(int, rename, const char*, const char*);
  struct Point point;
  if (!begin_path(&point, "rename", from)) return real(from, to);
  return (int)end(&point, real(from, to));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  REAL(int, renameat2, int, const char*, int, const char*, unsigned);
  struct Point point;
  if (!begin_path(&point, "renameat2", from)) return real(from_folder, from, to_folder, to, flags);
  return (int)end(&point, real(from_folder, from, to_folder, to, flags));
}

/* Files and sockets */

ssize_t write(int file, const void* data, size_t size) {
  REAL(ssize_t, write, int, const void*, size_t);
  struct Point point;
  if (!begin(&point, "write", file, (long long)size, 0)) return real(file, data, size);
  if (point.is_file) remember_write(file, lseek(file, 0, SEEK_CUR), size);
  return end(&point, real(file, data, size));
}

ssize_t writev(int file, const struct iovec* pieces, int count) {
  REAL(ssize_t, writev, int, const struct iovec*, int);
  struct Point point;
  const long long size = total(pieces, (size_t)count);
  if (!begin(&point, "writev", file, size, 0)) return real(file, pieces, count);
  if (point.is_file) remember_write(file, lseek(file, 0, SEEK_CUR), (size_t)size);
  return end(&point, real(file, pieces, count));
}

/* What is read from the ledger changes nothing: it is no point. */
ssize_t read(int file, void* data, size_t size) {
  REAL(ssize_t, read, int, void*, size_t);
  struct Point point;
  if (lseek(file, 0, SEEK_CUR) >= 0 || !begin(&point, "read", file, (long long)size, 0))
    return real(file, data, size);
  return end(&point, real(file, data, size));
}

/* Sockets */

ssize_t send(int file, const void* data, size_t size, int flags) {
  REAL(ssize_t, send, int, const void*, size_t, int);
  struct Point point;
  if (!begin(&point, "send", file, (long long)size, 0)) return real(file, data, size, flags);
  return end(&point, real(file, data, size, flags));
}

ssize_t sendto(int file, const void* data, size_t size, int flags, const struct sockaddr* to,
               socklen_t length) {
  REAL(ssize_t, sendto, int, const void*, size_t, int, const struct sockaddr*, socklen_t);
  struct Point point;
  if (!begin(&point, "sendto", file, (long long)size, 0)) return real(file, data, size, flags, to, length);
  return end(&point, real(file, data, size, flags, to, length));
}

ssize_t sendmsg(int file, const struct msghdr* message, int flags) {
  REAL(ssize_t, sendmsg, int, const struct msghdr*, int);
  struct Point point;
  const long long size = total(message->msg_iov, message->msg_iovlen);
  if (!begin(&point, "sendmsg", file, size, 0)) return real(file, message, flags);
  return end(&point, real(file, message, flags));
}

ssize_t sendfile64(int to, int from, off64_t* offset, size_t size) {
  REAL(ssize_t, sendfile64, int, int, off64_t*, size_t);
  struct Point point;
  if (!begin(&point, "sendfile64", to, (long long)size, 0)) return real(to, from, offset, size);
  return end(&point, real(to, from, offset, size));
}

ssize_t recv(int file, void* data, size_t size, int flags) {
  REAL(ssize_t, recv, int, void*, size_t, int);
  struct Point point;
  if (!begin(&point, "recv", file, (long long)size, 0)) return real(file, data, size, flags);
  return end(&point, real(file, data, size, flags));
}

ssize_t recvfrom(int file, void* data, size_t size, int flags, struct sockaddr* from, socklen_t* length) {
  REAL(ssize_t, recvfrom, int, void*, size_t, int, struct sockaddr*, socklen_t*);
  struct Point point;
  if (!begin(&point, "recvfrom", file, (long long)size, 0))
    return real(file, data, size, flags, from, length);
  return end(&point, real(file, data, size, flags, from, length));
}

ssize_t recvmsg(int file, struct msghdr* message, int flags) {
  REAL(ssize_t, recvmsg, int, struct msghdr*, int);
  struct Point point;
  const long long size = total(message->msg_iov, message->msg_iovlen);
  if (!begin(&point, "recvmsg", file, size, 0)) return real(file, message, flags);
  return end(&point, real(file, message, flags));
}
