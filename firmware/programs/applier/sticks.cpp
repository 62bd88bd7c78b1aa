#include "applier/sticks.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <thread>
#include <utility>

#include "host/disk.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/output.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "loop/regular_file.hpp"
#include "spare/sealed.hpp"
#include "spare/stick.hpp"

namespace adit::applier {
namespace {

using loop::FileDescriptor;

FileDescriptor open_folder(const std::string& path) {
  return FileDescriptor(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

std::unexpected<std::string> stick_error(const std::string& name, int error) {
  std::string why = host::path_error(name, error);
  if (error == ENOSPC || error == EDQUOT) why = "the stick is full";
  if (error == EROFS) why = "the stick is write-protected, or its file system is damaged";
  return std::unexpected(std::move(why));
}

/// 0, or errno.
int put(int folder, const std::string& name, const std::string& bytes) {
  const FileDescriptor file(
      openat(folder, kUnfinished, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, host::kForAll));
  if (!file) return errno;
  if (loop::write_all(file.get(), bytes, 0) != 0 || fsync(file.get()) != 0) return errno;
  if (renameat(folder, kUnfinished, folder, name.c_str()) != 0) return errno;
  return fsync(folder) == 0 && syncfs(folder) == 0 ? 0 : errno;
}

namespace fs = std::filesystem;

constexpr std::chrono::seconds kMount{90};
/// Another program may use the mount for a moment, and systemd removes the old mount's unit a moment later.
constexpr int kTries = 20;
constexpr std::chrono::milliseconds kBetween{100};

/// The options of adit-stick@.service after the first one.
constexpr const char* kOptions = ",nosuid,nodev,noexec,noatime,errors=remount-ro";

/// Not a link, directory or FIFO, which read_export() rejects.
bool is_plain_file(const std::string& path) {
  struct stat status{};
  return lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

std::expected<void, std::string> write_export(const std::string& folder, const std::string& name,
                                              const std::string& bytes) {
  const FileDescriptor in = open_folder(folder);
  if (!in) return stick_error("the stick", errno);
  unlinkat(in.get(), kUnfinished, 0);
  const int error = put(in.get(), name, bytes);
  if (error == 0) return {};
  unlinkat(in.get(), kUnfinished, 0);
  return stick_error(name, error);
}

std::expected<std::string, std::string> read_export(const std::string& folder, const std::string& name) {
  const FileDescriptor in = open_folder(folder);
  const FileDescriptor file =
      in ? loop::open_regular(name, O_RDONLY | O_NOFOLLOW, in.get()) : FileDescriptor();
  if (!file) return stick_error(name, errno);
  auto bytes = loop::read_all(file, spare::kLargestExport);
  if (bytes) return std::move(*bytes);
  if (bytes.error() == EFBIG) return std::unexpected(name + ": the file is larger than an export may be");
  return stick_error(name, bytes.error());
}

bool Sticks::is_in(const std::string& name) const {
  std::error_code error;
  return fs::exists(options_.block + '/' + name, error);
}

bool Sticks::is_mounted(const std::string& name) const {
  struct stat mounted{}, around{};
  if (stat(folder(name).c_str(), &mounted) != 0) return errno != ENOENT;  // as of a damaged file system
  return stat(options_.sticks.c_str(), &around) != 0 || mounted.st_dev != around.st_dev;
}

std::expected<std::vector<spare::Medium>, std::string> Sticks::media() const {
  std::vector<spare::Medium> media;
  const auto names = host::names_in(options_.sticks);
  if (!names) return std::unexpected("cannot list the sticks: " + options_.sticks + ": " + names.error());
  for (const std::string& name : *names) {
    if (!is_in(name)) continue;  // directory of a removed stick
    const std::string block = options_.block + '/' + name;
    std::error_code error;
    const fs::path itself = fs::canonical(block, error);
    const bool is_partition = fs::exists(block + "/partition", error);
    spare::Medium medium{.name = name, .is_mounted = is_mounted(name)};
    medium.disk = (is_partition ? itself.parent_path() : itself).filename();
    medium.is_write_protected = host::read_file(block + "/ro").value_or("").starts_with('1');
    if (const auto disk = host::disk_of(folder(name)); disk && medium.is_mounted) medium.room = disk->free;
    media.push_back(std::move(medium));
  }
  return media;
}

std::vector<std::string> Sticks::exports(std::span<const spare::Medium> media,
                                         std::string& unreadable) const {
  std::vector<std::string> found;
  unreadable.clear();
  for (const spare::Medium& medium : media) {
    if (!medium.is_mounted) {
      unreadable = spare::kUnknownFileSystem;
      continue;
    }
    const auto names = host::names_in(folder(medium.name), kMostAtTop);
    if (!names) unreadable = "cannot read the stick " + medium.name + ": " + names.error();
    for (const std::string& name : names.value_or(std::vector<std::string>())) {
      if (spare::is_file_name(name) && is_plain_file(folder(medium.name) + '/' + name) &&
          std::ranges::find(found, name) == found.end())
        found.push_back(name);
    }
  }
  if (!found.empty()) unreadable.clear();
  std::ranges::sort(found, spare::is_before);
  if (found.size() > kMost) found.resize(kMost);
  return found;
}

std::expected<std::string, std::string> Sticks::folder_with(const std::string& name) const {
  const auto all = ADIT_TRY(media());
  std::string why = "no stick has this export";
  for (const spare::Medium& medium : all) {
    if (!medium.is_mounted) continue;
    const std::string file = folder(medium.name) + '/' + name;
    struct stat status{};
    if (lstat(file.c_str(), &status) == 0) return folder(medium.name);
    if (errno != ENOENT) why = host::path_error(file, errno);
  }
  return std::unexpected(why);
}

std::expected<void, std::string> Sticks::unmount(const std::string& name) const {
  std::expected<void, std::string> done;
  for (int tries = 0; is_mounted(name) && tries < kTries; ++tries) {
    if (tries > 0) std::this_thread::sleep_for(kBetween);
    done = host::run_command({options_.mount, "--umount", folder(name)}, kMount);
  }
  if (!is_mounted(name)) return {};
  return std::unexpected("the stick is in use and could not be unmounted: " +
                         (done ? "systemd-mount gave no reason" : done.error()));
}

std::expected<void, std::string> Sticks::remount(const std::string& name, Mode mode) const {
  if (auto unmounted = unmount(name); !unmounted) return unmounted;
  const std::string how = std::string(mode == Mode::Writable ? "rw" : "ro") + kOptions;
  std::expected<void, std::string> done;
  for (int tries = 0; tries < kTries && is_in(name); ++tries) {
    done = host::run_command({options_.mount, "--collect", "--fsck=no", "--type=vfat,exfat,ext4",
                              "--options=" + how, options_.devices + '/' + name, folder(name)},
                             kMount);
    if (is_mounted(name)) return {};
    std::this_thread::sleep_for(kBetween);
  }
  if (!is_in(name)) return std::unexpected("the stick is gone");
  return std::unexpected("the stick could not be mounted: " +
                         (done ? "systemd-mount gave no reason" : done.error()));
}

void Sticks::settle() const {
  const auto all = media();
  if (!all)
    return host::log(host::Level::Error, "cannot mount sticks read-only again", {{"why", all.error()}});
  for (const spare::Medium& medium : *all) {
    struct statvfs now{};
    if (!medium.is_mounted || statvfs(folder(medium.name).c_str(), &now) != 0 ||
        (now.f_flag & ST_RDONLY) != 0)
      continue;
    host::log_failure(host::Level::Error, "cannot mount a stick read-only again",
                      remount(medium.name, Mode::ReadOnly));
  }
}

}  // namespace adit::applier
