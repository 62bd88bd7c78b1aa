#include "store/disk.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <fstream>
#include <utility>
#include <vector>

#include "simulation/real_calls.hpp"

namespace adit::store {
namespace {

namespace fs = std::filesystem;
namespace real = simulation::real;

Disk* the_one = nullptr;

/// Only the beginning, if a file is far longer than a test makes it.
std::string read_file(const fs::path& path) {
  if (!fs::is_regular_file(path)) return "";
  std::string bytes(std::min<std::uintmax_t>(fs::file_size(path), 1u << 20), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

std::string path_of(int fd) {
  std::error_code error;
  return fs::read_symlink("/proc/self/fd/" + std::to_string(fd), error).native();
}

}  // namespace

Disk::Disk(Random random, std::string directory)
    : random_(random), directory_(std::move(directory)), unsynced_(std::make_unique<simulation::Unsynced>()) {
  std::string name =
      (fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path().native()) + "/adit-store-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) std::abort();
  path_ = name;
  fs::create_directory(log());
  the_one = this;
}

Disk::~Disk() {
  the_one = nullptr;
  fs::remove_all(path_);
}

void Disk::start() {
  is_dead_ = false;
}

void Disk::cut_power() {
  unsynced_->cut(path_, random_);
  unsynced_ = std::make_unique<simulation::Unsynced>();
}

void Disk::flip_bit() {
  std::vector<std::pair<fs::path, std::size_t>> used;
  for (const auto& [name, bytes] : files()) {
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      if (bytes[at] != 0) used.emplace_back(fs::path(log()) / name, at);
    }
  }
  if (used.empty()) return;
  const auto& [path, at] = used[random_.uniform_index(used.size())];
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(at));
  const int byte = file.get();
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(byte ^ (1 << random_.uniform_index(8))));
}

void Disk::lengthen() {
  const auto all = files();
  if (!all.empty())
    fs::resize_file(
        fs::path(log()) /
            std::next(all.begin(), static_cast<std::ptrdiff_t>(random_.uniform_index(all.size())))->first,
        std::uintmax_t{1} << 40);
}

std::map<std::string, std::string> Disk::files() const {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(log()))
    files[entry.path().filename()] = read_file(entry.path());
  return files;
}

void Disk::replace(const std::map<std::string, std::string>& files) const {
  for (const auto& [name, bytes] : this->files()) fs::remove(fs::path(log()) / name);
  for (const auto& [name, bytes] : files) std::ofstream(fs::path(log()) / name, std::ios::binary) << bytes;
}

Disk* Disk::of(int fd, const char* name) {
  if (the_one == nullptr) return nullptr;
  const std::string path = name != nullptr && *name == '/' ? name : path_of(fd);
  return path.starts_with(the_one->path_) ? the_one : nullptr;
}

std::string Disk::name_of(int fd) const {
  const std::string path = path_of(fd);
  return path.size() > path_.size() ? path.substr(path_.size() + 1) : "";
}

void Disk::may_be_killed() {
  const bool is_due = kill_at != 0 && --kill_at == 0;
  if (is_dead_ || !(is_due || random_.chance(kills))) return;
  is_dead_ = true;
  throw Killed();
}

bool Disk::fails(double chance, int error) {
  if (is_dead_ || !random_.chance(chance)) return false;
  errno = error;
  return true;
}

std::optional<simulation::Content> Disk::content(const std::string& name) const {
  const fs::path path = fs::path(path_) / name;
  if (!fs::is_regular_file(path)) return std::nullopt;
  return simulation::Content{read_file(path), fs::file_size(path)};
}

int Disk::open(int folder, const char* name, int flags, mode_t mode) {
  const bool makes = (flags & O_CREAT) != 0;
  may_be_killed();
  if (is_read_only && (makes || (flags & O_ACCMODE) != O_RDONLY)) {
    errno = EROFS;
    return -1;
  }
  const bool is_failing = !failing_file.empty() && std::string_view(name).starts_with(failing_file);
  if (fails(is_failing ? 1 : 0, EIO) || fails(failing_opens, EMFILE) || (makes && fails(full, ENOSPC)))
    return -1;
  if (is_dead_ && makes) return -1;
  const int fd =
      real::open(folder, name, (flags & O_ACCMODE) == O_WRONLY ? (flags & ~O_ACCMODE) | O_RDWR : flags, mode);
  if (fd >= 0 && makes) unsynced_->made(name_of(fd));
  may_be_killed();
  return fd;
}

/// A kill ends a write at the end of a sector.
ssize_t Disk::write(int fd, const char* bytes, std::size_t size, off_t at) {
  may_be_killed();
  if (is_dead_ || fails(failing_writes, EIO)) return -1;
  const bool is_cut = random_.chance(kills) || random_.chance(failing_writes);
  const std::size_t count = is_cut ? std::min(size, random_.uniform_index(size / 512 + 1) * 512) : size;
  if (count > 0) {
    struct stat status{};
    ::fstat(fd, &status);
    const auto end = static_cast<std::size_t>(status.st_size), place = static_cast<std::size_t>(at);
    const std::size_t growth = std::max(end, place + count) - end;
    if (room && growth > *room) {
      errno = ENOSPC;
      return -1;
    }
    if (room) *room -= growth;
    std::string before(std::min(count, end - std::min(end, place)), '\0');
    if (::pread(fd, before.data(), before.size(), at) < 0) std::abort();
    unsynced_->file(name_of(fd))->wrote(place, std::string(bytes, count), std::move(before), end);
    if (::syscall(SYS_pwrite64, fd, bytes, count, at) < 0) std::abort();
  }
  may_be_killed();
  if (count > 0) return static_cast<ssize_t>(count);
  errno = EIO;
  return -1;
}

int Disk::sync(int fd) {
  may_be_killed();
  if (is_dead_) return 0;
  const std::string name = name_of(fd);
  const bool is_folder = fs::is_directory(path_of(fd));
  if (fails(failing_syncs, EIO)) {
    if (!is_folder) unsynced_->file(name)->sync_failed();
    return -1;
  }
  is_folder ? unsynced_->synced_folder(name) : unsynced_->file(name)->synced();
  may_be_killed();
  return 0;
}

int Disk::rename(const char* from, const char* to) {
  may_be_killed();
  if (is_dead_ || fails(failing_writes, EIO)) return -1;
  const int result =
      real::rename(AT_FDCWD, (log() + '/' + from).c_str(), AT_FDCWD, (log() + '/' + to).c_str());
  if (result == 0) unsynced_->renamed(directory_ + '/' + from, directory_ + '/' + to, std::nullopt);
  return result;
}

int Disk::remove(const char* name) {
  if (is_dead_ || fails(failing_writes, EIO)) return -1;
  auto removed = content(directory_ + '/' + name);
  const int result = real::unlink(AT_FDCWD, (log() + '/' + name).c_str(), 0);
  if (result == 0 && room && removed) *room += removed->size;
  if (result == 0) unsynced_->removed(directory_ + '/' + name, std::move(removed));
  return result;
}

}  // namespace adit::store

// In front of libc's own (ELF: the program's come before a library's).
// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl50-cpp,cert-dcl51-cpp)
#define ADIT_STANDS_FOR(name) __asm__(name) __attribute__((visibility("default"), used))

extern "C" {

using adit::store::Disk;
namespace real = adit::simulation::real;

int adit_openat(int folder, const char* name, int flags, ...) ADIT_STANDS_FOR("openat");
ssize_t adit_pwrite(int fd, const void* bytes, std::size_t size, off_t at) ADIT_STANDS_FOR("pwrite");
int adit_fsync(int fd) ADIT_STANDS_FOR("fsync");
int adit_fdatasync(int fd) ADIT_STANDS_FOR("fdatasync");
int adit_fstatvfs(int fd, struct statvfs* disk) ADIT_STANDS_FOR("fstatvfs");
int adit_renameat(int from_folder, const char* from, int to_folder, const char* to)
    ADIT_STANDS_FOR("renameat");
int adit_unlinkat(int folder, const char* name, int flags) ADIT_STANDS_FOR("unlinkat");

int adit_openat(int folder, const char* name, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  Disk* const disk = Disk::of(folder, name);
  return disk != nullptr ? disk->open(folder, name, flags, mode) : real::open(folder, name, flags, mode);
}
ssize_t adit_pwrite(int fd, const void* bytes, std::size_t size, off_t at) {
  Disk* const disk = Disk::of(fd, nullptr);
  return disk != nullptr ? disk->write(fd, static_cast<const char*>(bytes), size, at)
                         : ::syscall(SYS_pwrite64, fd, bytes, size, at);
}
int adit_fsync(int fd) {
  Disk* const disk = Disk::of(fd, nullptr);
  return disk != nullptr ? disk->sync(fd) : real::sync(fd);
}
int adit_fdatasync(int fd) {
  return adit_fsync(fd);
}
/// Without `room` the disk is as large as the real one.
int adit_fstatvfs(int fd, struct statvfs* disk) {
  const Disk* const simulated = Disk::of(fd, nullptr);
  if (simulated == nullptr || !simulated->room)
    return ::statvfs(("/proc/self/fd/" + std::to_string(fd)).c_str(), disk);
  *disk = {};
  disk->f_frsize = 1;
  disk->f_bavail = *simulated->room;
  return 0;
}
int adit_renameat(int from_folder, const char* from, int to_folder, const char* to) {
  Disk* const disk = Disk::of(from_folder, from);
  return disk != nullptr ? disk->rename(from, to) : real::rename(from_folder, from, to_folder, to);
}
int adit_unlinkat(int folder, const char* name, int flags) {
  Disk* const disk = Disk::of(folder, name);
  return disk != nullptr && (flags & AT_REMOVEDIR) == 0 && *name != '/' ? disk->remove(name)
                                                                        : real::unlink(folder, name, flags);
}
}
// NOLINTEND(bugprone-reserved-identifier,cert-dcl50-cpp,cert-dcl51-cpp)
