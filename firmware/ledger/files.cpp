#include "ledger/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <vector>

namespace adit::ledger {
namespace {

constexpr std::array kBeside = {"-wal", "-shm", "-journal"};
constexpr const char* kTrial = "ledger.try-";
constexpr int kMostAside = 10'000;

Result<void> set_mode(const std::string& path) {
  if (::chmod(path.c_str(), 0600) == 0) return {};
  return std::unexpected(system_error("chmod 0600 " + path));
}

Error::Kind kind_of(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return Error::Kind::Full;
    case EROFS:
    case EACCES:
    case EPERM:
      return Error::Kind::ReadOnly;
    case EIO:
    case loop::kNotRegular:
      return Error::Kind::Failing;
    default:
      return Error::Kind::Other;
  }
}

}  // namespace

Error system_error(const std::string& doing) {
  const int code = errno;
  return {kind_of(code), doing + ": " + loop::text_of(code)};
}

bool exists(const std::string& path) {
  struct stat found{};
  return ::lstat(path.c_str(), &found) == 0 || (errno != ENOENT && errno != ENOTDIR);
}

Result<loop::FileDescriptor> lock_folder(const std::string& folder) {
  loop::FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened && ::flock(opened.get(), LOCK_EX | LOCK_NB) == 0) return opened;
  if (opened && errno == EWOULDBLOCK)
    return std::unexpected(Error{.what = "opening " + folder + ": another process has the ledger open"});
  return std::unexpected(system_error("opening " + folder));
}

Result<std::string> read_file(const std::string& path) {
  const loop::FileDescriptor file = loop::open_regular(path, O_RDONLY);
  if (!file && errno == ENOENT) return std::string();
  if (!file) return std::unexpected(system_error("reading " + path));
  auto bytes = loop::read_all(file, std::numeric_limits<std::size_t>::max());
  if (bytes) return std::move(*bytes);
  errno = bytes.error();
  return std::unexpected(system_error("reading " + path));
}

Result<void> check_regular(const std::string& path) {
  if (loop::open_regular(path, O_RDONLY) || errno == ENOENT) return {};
  return std::unexpected(system_error("opening " + path));
}

Result<void> make_file(const std::string& path) {
  const loop::FileDescriptor made(::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600));
  if (!made && errno != EEXIST) return std::unexpected(system_error("creating " + path));
  return set_mode(path);
}

Result<void> sync_folder(const std::string& folder) {
  const loop::FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened || ::fsync(opened.get()) != 0) return std::unexpected(system_error("syncing " + folder));
  return {};
}

Result<void> try_writing(const std::string& folder) {
  auto tried = try_room(folder, 0);
  if (tried || tried.error().kind != Error::Kind::ReadOnly)
    return {};  // what else there is says whoever writes
  return tried;
}

Result<void> try_room(const std::string& folder, std::int64_t bytes) {
  std::string path = folder + "/" + kTrial + "XXXXXX";
  const loop::FileDescriptor made(::mkostemp(path.data(), O_CLOEXEC));
  if (!made) return std::unexpected(system_error("writing to " + folder));
  ::unlink(path.c_str());
  const int failed = bytes == 0 ? 0 : ::posix_fallocate(made.get(), 0, bytes);
  errno = failed;
  if (failed != 0) return std::unexpected(system_error("writing to " + folder));
  return {};
}

std::vector<std::string> beginning_with(const std::string& folder, std::string_view begins) {
  std::vector<std::string> paths;
  std::error_code error;
  for (std::filesystem::directory_iterator each(folder, error), end; !error && each != end;
       each.increment(error)) {
    if (each->path().filename().string().starts_with(begins)) paths.push_back(each->path().string());
  }
  return paths;
}

void remove_trials(const std::string& folder) {
  for (const std::string& path : beginning_with(folder, kTrial)) ::unlink(path.c_str());
}

Result<void> try_opening(const std::string& path) {
  const loop::FileDescriptor file = loop::open_regular(path, O_RDWR);
  if (!file && errno == ENOENT) return {};
  if (!file) return std::unexpected(system_error("opening " + path));
  return set_mode(path);
}

std::int64_t size_of(const std::string& path) {
  struct stat found{};
  return ::lstat(path.c_str(), &found) == 0 ? found.st_size : 0;
}

Result<void> rename_file(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) == 0) return {};
  return std::unexpected(system_error("renaming " + from));
}

Result<void> copy_database(const std::string& from, const std::string& to) {
  for (const char* suffix : {"", "-wal", "-journal", ".salvaged"}) {
    if (!exists(from + suffix)) continue;
    const auto bytes = read_file(from + suffix);
    if (!bytes) return std::unexpected(bytes.error());
    const loop::FileDescriptor file(
        ::open((to + suffix).c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0600));
    if (!file) return std::unexpected(system_error("copying " + from + suffix));
    for (std::size_t had = 0; had < bytes->size();) {
      const ssize_t more = ::write(file.get(), bytes->data() + had, bytes->size() - had);
      if (more < 0) return std::unexpected(system_error("copying " + from + suffix));
      had += static_cast<std::size_t>(more);
    }
  }
  return {};
}

void remove_database(const std::string& path) {
  ::unlink(path.c_str());
  for (const char* suffix : kBeside) ::unlink((path + suffix).c_str());
}

Result<std::string> set_aside(const std::string& folder, const std::string& path) {
  for (int n = 1; n <= kMostAside; ++n) {
    std::string aside = path + ".damaged-" + std::to_string(n);
    bool is_free = !exists(aside);
    for (const char* suffix : kBeside) is_free = is_free && !exists(aside + suffix);
    if (!is_free) continue;
    if (exists(path)) {
      if (auto moved = rename_file(path, aside); !moved) return std::unexpected(moved.error());
    }
    for (const char* suffix : kBeside) {  // one left behind would be taken for the new file's
      if (!exists(path + suffix)) continue;
      if (auto moved = rename_file(path + suffix, aside + suffix); !moved)
        return std::unexpected(moved.error());
    }
    if (auto synced = sync_folder(folder); !synced) return std::unexpected(synced.error());
    return aside;
  }
  return std::unexpected(Error{.what = "renaming " + path + ": no free name"});
}

}  // namespace adit::ledger
