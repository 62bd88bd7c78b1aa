#include "store/directory.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <optional>
#include <tuple>

#include "icd/text.hpp"
#include "icd/try.hpp"
#include "loop/regular_file.hpp"

namespace adit::store {
namespace {

Error::Cause cause_of(int number) {
  if (number == ENOSPC || number == EDQUOT || number == EFBIG) return Error::Cause::Full;
  if (number == EROFS || number == EACCES || number == EPERM) return Error::Cause::NoWrite;
  return number == EIO ? Error::Cause::Failing : Error::Cause::Other;
}

}  // namespace

std::unexpected<Error> path_error(const std::string& path, int number) {
  return std::unexpected(Error{cause_of(number), path + ": " + loop::text_of(number)});
}

namespace {

constexpr std::array<std::string_view, 3> kBeginnings{"log-", "snapshot-", "spare-"};  // by FileName::Kind
constexpr std::size_t kSaltDigits = 16;

std::optional<FileName> parse_name(std::string_view name) {
  for (std::size_t kind = 0; kind < kBeginnings.size(); ++kind) {
    const std::size_t begin = kBeginnings[kind].size(), point = name.find('.');
    if (!name.starts_with(kBeginnings[kind]) || point == name.npos) continue;
    const auto number = icd::number_in<std::uint64_t>(name.substr(begin, point - begin));
    const auto salt = icd::number_in<std::uint64_t>(name.substr(point + 1), 16);
    if (number && salt && name.size() == point + 1 + kSaltDigits)
      return FileName{static_cast<FileName::Kind>(kind), *number, *salt};
  }
  return std::nullopt;
}

}  // namespace

std::string FileName::text() const {
  std::array<char, 64> end;
  (void)std::snprintf(end.data(), end.size(), "%08" PRIu64 ".%016" PRIx64, number, salt);
  return std::string(kBeginnings[static_cast<std::size_t>(kind)]) + end.data();
}

Result<Directory> Directory::open(const std::string& path) {
  Directory directory;
  directory.path_ = path;
  directory.fd_ = loop::FileDescriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!directory.fd_) return path_error(path, errno);
  return directory;
}

Result<Directory> Directory::lock(const std::string& path) {
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) return path_error(path, errno);
  auto directory = open(path);
  if (!directory) return directory;
  if (::flock(directory->fd_.get(), LOCK_EX | LOCK_NB) == 0) return directory;
  if (errno != EWOULDBLOCK) return path_error(path, errno);
  return std::unexpected(Error{Error::Cause::InUse, path + ": another process has it open"});
}

Result<std::vector<std::string>> Directory::names() const {
  const int again = ::openat(fd_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);  // closedir() closes it
  const std::unique_ptr<DIR, int (*)(DIR*)> all(again < 0 ? nullptr : ::fdopendir(again), ::closedir);
  if (!all) {
    const int number = errno;
    if (again >= 0) loop::close_descriptor(again);
    return path_error(path_, number);
  }
  std::vector<std::string> names;
  errno = 0;
  while (const dirent* entry = ::readdir(all.get())) names.emplace_back(entry->d_name);
  if (errno != 0) return path_error(path_, errno);
  return names;
}

Result<std::vector<FileName>> Directory::files() const {
  const auto all = ADIT_TRY(names());
  std::vector<FileName> files;
  for (const std::string& name : all) {
    if (const auto file = parse_name(name)) files.push_back(*file);
  }
  std::ranges::sort(files, {},
                    [](const FileName& file) { return std::tuple(file.kind, file.number, file.salt); });
  return files;
}

Result<std::string> Directory::read(const std::string& name, std::size_t most) const {
  const auto file = loop::open_regular(name, O_RDONLY | O_NOFOLLOW, fd_.get());
  if (!file) return file_error(name, errno);
  auto bytes = loop::read_first(file, most);
  if (!bytes) return file_error(name, bytes.error());
  return std::move(*bytes);
}

Result<loop::FileDescriptor> Directory::make(const std::string& name) const {
  loop::FileDescriptor file(::openat(fd_.get(), name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file) return file_error(errno);
  return file;
}

Result<loop::FileDescriptor> Directory::open_to_write(const std::string& name) const {
  auto file = loop::open_regular(name, O_WRONLY | O_NOFOLLOW, fd_.get());
  if (!file) return file_error(name, errno);
  return file;
}

std::optional<std::uint64_t> Directory::size(const std::string& name) const {
  struct stat status{};
  if (::fstatat(fd_.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(status.st_mode))
    return std::nullopt;
  return static_cast<std::uint64_t>(status.st_size);
}

Result<void> Directory::rename(const std::string& from, const std::string& to) const {
  if (::renameat(fd_.get(), from.c_str(), fd_.get(), to.c_str()) != 0) return file_error(from, errno);
  return {};
}

Result<void> Directory::remove(const std::string& name) const {
  if (::unlinkat(fd_.get(), name.c_str(), 0) != 0 && errno != ENOENT) return file_error(name, errno);
  return {};
}

Result<void> Directory::remove_parts() const {
  const auto all = ADIT_TRY(names());
  for (const std::string& name : all) {
    if (!name.ends_with(kPart)) continue;
    if (auto removed = remove(name); !removed) return removed;
  }
  return {};
}

Result<std::string> Directory::first_free(const std::string& beginning) const {
  const auto all = ADIT_TRY(names());
  for (int number = 1;; ++number) {
    std::string name = beginning + std::to_string(number);
    if (std::ranges::find(all, name) == all.end()) return name;
  }
}

Result<void> Directory::put_aside() const {
  const auto all = ADIT_TRY(files());
  if (all.empty()) return {};
  const auto aside = ADIT_TRY(first_free("damaged-"));
  if (::mkdirat(fd_.get(), aside.c_str(), 0700) != 0) return file_error(aside, errno);
  for (const FileName& file : all) {
    const std::string name = file.text(), link = aside + '/' + name;
    if (file.kind == FileName::Kind::Spare) continue;
    if (::linkat(fd_.get(), name.c_str(), fd_.get(), link.c_str(), 0) != 0) return file_error(link, errno);
  }
  return sync();
}

Result<std::string> Directory::rename_aside(const std::string& name) const {
  auto aside = first_free(name + ".damaged-");
  if (!aside) return aside;
  ADIT_TRY(rename(name, *aside));
  ADIT_TRY(sync());
  return aside;
}

Result<void> Directory::sync() const {
  if (::fsync(fd_.get()) != 0) return path_error(path_, errno);
  return {};
}

Result<void> Directory::sync_name() const {
  const auto slash = path_.rfind('/');
  const auto above = ADIT_TRY(open(slash == path_.npos ? "." : path_.substr(0, slash)));
  return above.sync();
}

Result<std::uint64_t> random_salt() {
  std::uint64_t salt = 0;
  if (::getrandom(&salt, sizeof salt, 0) != sizeof salt) return path_error("random numbers", errno);
  return salt;
}

}  // namespace adit::store
