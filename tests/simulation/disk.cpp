#include "simulation/disk.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "simulation/real_calls.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr std::uint64_t kPageBytes = 4096;
Disk* the_disk = nullptr;

int fail(int error) {
  errno = error;
  return -1;
}

std::uint64_t size_of(int fd) {
  struct stat found{};
  return real::status(fd, &found) == 0 ? static_cast<std::uint64_t>(found.st_size) : 0;
}

std::string bytes_at(int fd, off_t at, std::uint64_t size) {
  std::string bytes;
  bytes.resize_and_overwrite(size, [&](char* to, std::size_t room) {
    return static_cast<std::size_t>(std::max<ssize_t>(0, real::read_at(fd, to, room, at)));
  });
  return bytes;
}

/// The offset at which the hole at the file's end begins.
std::uint64_t end_of_data(int fd, std::uint64_t size) {
  const off_t hole = size == 0 ? 0 : ::lseek(fd, 0, SEEK_HOLE);
  return ::lseek(fd, hole, SEEK_DATA) < 0 ? static_cast<std::uint64_t>(hole) : size;
}

bool is_folder(const std::string& path) {
  struct stat found{};
  return real::status(AT_FDCWD, path.c_str(), &found, AT_SYMLINK_NOFOLLOW) == 0 && S_ISDIR(found.st_mode);
}

std::string mark_of(const std::string& bytes) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3u;
  return std::to_string(hash % 1000000);
}

}  // namespace

Disk::Disk(World& world)
    : world_(world),
      random_(world.random("disk")),
      unique_(world.random("names")),
      faults_(world),
      calls_(world) {
  the_disk = this;
}

Disk::~Disk() {
  the_disk = nullptr;
}

bool Disk::is_on() {
  return the_disk != nullptr && !the_disk->world_.is_dead() && !the_disk->looks_on_;
}

Disk* Disk::of(int folder, const char* path) {
  if (!is_on() || path == nullptr) return nullptr;
  return the_disk->name_of(folder, path).empty() ? nullptr : the_disk;
}

Disk* Disk::of(int fd) {
  if (!is_on()) return nullptr;
  const auto open = the_disk->open_.find(fd);
  struct stat found{};
  if (open == the_disk->open_.end()) return nullptr;
  const bool is_it = real::status(fd, &found) == 0 && found.st_dev == open->second.device &&
                     found.st_ino == open->second.number;
  if (!is_it) the_disk->open_.erase(open);
  return is_it ? the_disk : nullptr;
}

void Disk::forget(int fd) {
  if (the_disk == nullptr) return;
  the_disk->open_.erase(fd);
  the_disk->world_.door().server_closed(fd);
}

void Disk::mount(const std::filesystem::path& folder) {
  folder_ = folder.string() + '/';
}

void Disk::cut_power(const std::filesystem::path& tree) {
  unsynced_.cut(tree, random_);
}

/// "" if the path is not in the box's directory.
std::string Disk::name_of(int folder, const char* path) const {
  if (path[0] != '/') {
    const auto open = open_.find(folder);
    return open == open_.end() ? "" : open->second.name + '/' + path;
  }
  const std::string whole = path;
  return whole.starts_with(folder_) ? whole.substr(folder_.size()) : "";
}

bool Disk::is_in_memory(const std::string& name) {
  return name == kRuntime || name.starts_with(std::string(kRuntime) + '/');
}

bool Disk::is_read_only(const std::string& name) const {
  return !is_in_memory(name) && faults_.is(DiskFaults::Kind::ReadOnly);
}

bool Disk::is_full(const std::string& name) const {
  return faults_.is(is_in_memory(name) ? DiskFaults::Kind::RuntimeFull : DiskFaults::Kind::Full);
}

std::uint64_t Disk::take_room(const std::string& name, std::uint64_t bytes) {
  if (!is_full(name)) return bytes;
  std::uint64_t& left = faults_.room(is_in_memory(name));
  const std::uint64_t taken = std::min(left, bytes);
  left -= taken;
  return taken;
}

std::uint64_t Disk::room(int folder, const char* path) {
  const std::string name = name_of(folder, path);
  return is_full(name) ? faults_.room(is_in_memory(name)) : kRoom;
}

std::uint64_t Disk::room(int fd) {
  const std::string& name = open_.at(fd).name;
  return is_full(name) ? faults_.room(is_in_memory(name)) : kRoom;
}

std::optional<Content> Disk::content_of(const std::string& name) const {
  if (is_in_memory(name) || is_folder(folder_ + name)) return std::nullopt;
  const int file = real::open(AT_FDCWD, (folder_ + name).c_str(), O_RDONLY | O_CLOEXEC, 0);
  if (file < 0) return std::nullopt;
  const std::uint64_t size = size_of(file);
  Content content{bytes_at(file, 0, end_of_data(file, size)), size};
  real::close(file);
  return content;
}

int Disk::open(int folder, const char* path, int flags, mode_t mode) {
  const std::string name = name_of(folder, path);
  if (const int error = calls_.error(CallFaults::Call::Open, name); error != 0) return fail(error);
  const bool writes = (flags & O_ACCMODE) != O_RDONLY;
  struct stat found{};
  const bool is_there = real::status(folder, path, &found, 0) == 0;
  if (!is_there && (flags & O_CREAT) == 0) return -1;
  const bool is_file = is_there && S_ISREG(found.st_mode);
  if (!writes && is_file && name.starts_with("state/") && faults_.is(DiskFaults::Kind::Unreadable))
    return fail(EIO);
  const bool makes = (flags & O_CREAT) != 0 && !is_there;
  const bool cuts = writes && (flags & O_TRUNC) != 0 && is_there && found.st_size > 0;
  if ((writes || makes) && is_read_only(name)) return fail(EROFS);
  if (makes && is_full(name) && faults_.room(is_in_memory(name)) == 0) return fail(ENOSPC);
  if (makes || cuts) world_.crossing();
  // Opened for reading too, because overwritten bytes are read first.
  const int how = (flags & O_ACCMODE) == O_WRONLY ? (flags & ~O_ACCMODE) | O_RDWR : flags;
  const int fd = real::open(folder, path, how & ~O_TRUNC, mode);
  if (fd < 0 || world_.is_dead()) return fd;
  real::status(fd, &found);
  Open open{.name = name,
            .file = nullptr,
            .appends = (flags & O_APPEND) != 0,
            .is_folder = S_ISDIR(found.st_mode),
            .device = found.st_dev,
            .number = found.st_ino};
  if (!is_in_memory(name)) {
    if (makes) unsynced_.made(name);
    if (writes) open.file = unsynced_.file(name);
  }
  open_[fd] = std::move(open);
  if (cuts) truncate(fd, 0);
  if (makes) world_.crossing();
  return fd;
}

ssize_t Disk::write(int fd, std::span<const char> bytes, std::optional<off_t> at) {
  const Open open = open_.at(fd);
  const auto part = cut(CallFaults::Call::Write, fd, bytes.size());
  world_.crossing();
  if (is_read_only(open.name)) return fail(EROFS);
  if (!part) return fail(EIO);
  bytes = bytes.first(*part);
  const auto size = static_cast<off_t>(size_of(fd));
  const off_t place = at ? *at : open.appends ? size : ::lseek(fd, 0, SEEK_CUR);
  const std::uint64_t there = std::min<std::uint64_t>(bytes.size(), std::max<off_t>(0, size - place));
  bytes = bytes.first(there + take_room(open.name, bytes.size() - there));
  if (bytes.empty()) return fail(ENOSPC);
  if (world_.dies_next()) {  // dies within this call
    put(fd, open, bytes.first(cut(open, bytes.size(), place)), place);
    world_.crossing();
  }
  const ssize_t count = put(fd, open, bytes, place);
  if (!at && count > 0) ::lseek(fd, place + count, SEEK_SET);
  world_.crossing();
  return count;
}

/// The number of bytes, of `size`, that a call reads or writes; nullopt if it fails. After a short call the
/// next one fails.
std::optional<std::size_t> Disk::cut(CallFaults::Call call, int fd, std::size_t size) {
  Open& open = open_.at(fd);
  if (std::exchange(open.is_broken, false)) return std::nullopt;
  const auto part = calls_.cut(call, open.name, size);
  if (!part) return size;
  open.is_broken = *part > 0;
  return open.is_broken ? part : std::nullopt;
}

ssize_t Disk::read(int fd, void* to, std::size_t size, std::optional<off_t> at) {
  const auto part = size == 0 ? size : cut(CallFaults::Call::Read, fd, size);
  if (!part) return fail(EIO);
  if (const auto less = calls_.cut(CallFaults::Call::Less, open_.at(fd).name, *part))
    size = std::max<std::size_t>(*less, 1);
  size = std::min(size, *part);
  return at ? real::read_at(fd, to, size, *at) : real::read(fd, to, size);
}

int Disk::fails(CallFaults::Call call, int fd) {
  const int error = calls_.error(call, open_.at(fd).name);
  return error == 0 ? 0 : fail(error);
}

int Disk::fails(CallFaults::Call call, int folder, const char* path) {
  const int error = calls_.error(call, name_of(folder, path));
  return error == 0 ? 0 : fail(error);
}

/// The length of a write in which the process dies. The kernel cuts a write only between two pages. In
/// memory it is cut at any byte, which is harder.
std::uint64_t Disk::cut(const Open& open, std::uint64_t size, off_t at) {
  const std::uint64_t part = random_.uniform_index(size), place = static_cast<std::uint64_t>(at);
  if (is_in_memory(open.name)) return part;
  const std::uint64_t end = (place + part) / kPageBytes * kPageBytes;
  return end > place ? end - place : 0;
}

ssize_t Disk::put(int fd, const Open& open, std::span<const char> bytes, off_t at) {
  if (open.file && !world_.is_dead() && !bytes.empty()) {
    const std::uint64_t size = size_of(fd), place = static_cast<std::uint64_t>(at);
    const std::uint64_t there = std::min<std::uint64_t>(bytes.size(), size - std::min(size, place));
    if (real::may_be_hole(fd, bytes, at)) {
      open.file->wrote_zeros(place, bytes.size(), size);
    } else {
      open.file->wrote(place, std::string(bytes.data(), bytes.size()), bytes_at(fd, at, there), size);
    }
  }
  return real::write_at(fd, bytes, at);
}

int Disk::truncate(int fd, off_t size) {
  const Open open = open_.at(fd);
  if (is_read_only(open.name)) return fail(EROFS);
  world_.crossing();
  const std::uint64_t before = size_of(fd), after = static_cast<std::uint64_t>(size);
  if (open.file && !world_.is_dead() && before != after)
    open.file->resized(before, after, after < before ? bytes_at(fd, size, before - after) : "");
  return real::truncate(fd, size);
}

int Disk::allocate(int fd, int mode, off_t at, off_t size) {
  const Open open = open_.at(fd);
  if (is_read_only(open.name)) return fail(EROFS);
  const std::uint64_t before = size_of(fd), end = static_cast<std::uint64_t>(at + size);
  if (end > before && take_room(open.name, end - before) < end - before) return fail(ENOSPC);
  world_.crossing();
  if (open.file && !world_.is_dead() && end > before) open.file->resized(before, end, "");
  return real::allocate(fd, mode, at, size);
}

/// Files in memory need no sync.
int Disk::sync(int fd) {
  const Open open = open_.at(fd);
  if (is_in_memory(open.name)) return 0;
  world_.crossing();
  if (const double takes = faults_.sync_takes(); takes > 0) world_.stand_still(seconds(takes));
  if (world_.is_dead()) return 0;
  if (is_read_only(open.name)) return fail(EROFS);
  if (faults_.sync_fails()) {
    if (open.file) open.file->sync_failed();
    return fail(EIO);
  }
  if (open.is_folder) unsynced_.synced_folder(open.name);
  if (open.file) open.file->synced();
  world_.crossing();
  return 0;
}

int Disk::rename(int from_folder, const char* from, int to_folder, const char* to) {
  const std::string old_name = name_of(from_folder, from), name = name_of(to_folder, to);
  if (is_read_only(name)) return fail(EROFS);
  if (name == kSettings) note_settings(mark_of(content_of(old_name).value_or(Content()).bytes));
  world_.crossing();
  auto replaced = content_of(name);
  const int result = real::rename(from_folder, from, to_folder, to);
  if (result != 0 || world_.is_dead()) return result;
  if (!is_in_memory(name)) unsynced_.renamed(old_name, name, std::move(replaced));
  for (auto& [fd, open] : open_) {
    if (open.name == old_name) open.name = name;
  }
  world_.crossing();
  return result;
}

int Disk::unlink(int folder, const char* path, int flags) {
  const std::string name = name_of(folder, path);
  if (is_read_only(name)) return fail(EROFS);
  if (name == kSettings) note_settings("");
  world_.crossing();
  auto content = content_of(name);
  struct stat found{};
  const bool is_there = real::status(folder, path, &found, AT_SYMLINK_NOFOLLOW) == 0;
  const int result = real::unlink(folder, path, flags);
  if (result != 0 || !is_there || world_.is_dead()) return result;
  if (S_ISREG(found.st_mode)) faults_.room(is_in_memory(name)) += static_cast<std::uint64_t>(found.st_size);
  if (!is_in_memory(name)) unsynced_.removed(name, std::move(content));
  world_.crossing();
  return result;
}

int Disk::make_folder(int folder, const char* path, mode_t mode) {
  const std::string name = name_of(folder, path);
  struct stat found{};
  if (real::status(folder, path, &found, 0) == 0) return fail(EEXIST);
  if (is_read_only(name)) return fail(EROFS);
  if (is_full(name) && faults_.room(is_in_memory(name)) == 0) return fail(ENOSPC);
  world_.crossing();
  const int result = real::make_folder(folder, path, mode);
  if (result == 0 && !world_.is_dead() && !is_in_memory(name)) unsynced_.made(name);
  return result;
}

int Disk::link(int from_folder, const char* from, int to_folder, const char* to) {
  const std::string name = name_of(to_folder, to);
  if (is_read_only(name)) return fail(EROFS);
  if (is_full(name) && faults_.room(is_in_memory(name)) == 0) return fail(ENOSPC);
  world_.crossing();
  const int result = real::link(from_folder, from, to_folder, to);
  if (result == 0 && !world_.is_dead() && !is_in_memory(name)) unsynced_.made(name);
  return result;
}

bool Disk::fill_random(void* bytes, std::size_t size) {
  if (the_disk == nullptr) return false;
  std::generate_n(static_cast<char*>(bytes), size,
                  [] { return static_cast<char>(the_disk->unique_.uniform_index(256)); });
  return true;
}

std::string Disk::settings() const {
  const auto content = content_of(kSettings);
  return content ? mark_of(content->bytes) : "";
}

std::uint64_t Disk::stored(const std::string& beginning) {
  std::uint64_t bytes = 0;
  look_on([&] {
    std::error_code gone;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_, gone)) {
      if (entry.is_regular_file(gone) && entry.path().native().starts_with(folder_ + beginning))
        bytes += entry.file_size(gone);
    }
  });
  return bytes;
}

void Disk::look_on(const std::function<void()>& look) {
  looks_on_ = true;
  look();
  looks_on_ = false;
}

void Disk::note_settings(const std::string& mark) {
  world_.note({.actor = Actor::Disk, .kind = Kind::Written, .what = "settings", .who = mark});
}

int Disk::may_change(int folder, const char* path) {
  return is_read_only(name_of(folder, path)) ? fail(EROFS) : 0;
}

std::string Disk::unique() {
  std::string letters(6, ' ');
  for (char& letter : letters) letter = static_cast<char>('a' + unique_.uniform_index(26));
  return letters;
}

}  // namespace adit::simulation
