#include "ledger/opening.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "ledger/tables.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::ledger {
namespace {

/// One process owns the ledger, so its lock is exclusive; that also keeps WAL's index out of a shared file.
constexpr const char* kPragmas = R"(
  PRAGMA locking_mode = EXCLUSIVE;
  PRAGMA cell_size_check = ON;
  PRAGMA trusted_schema = OFF;
  PRAGMA synchronous = FULL;
  PRAGMA wal_autocheckpoint = 960;
  PRAGMA journal_size_limit = 4194304;
)";

/// The write-ahead log's size from the start (journal_size_limit is the same). A flush of bytes that are
/// there already is one write to the disk; where a file grows, its file system's journal is another. 960
/// pages, with the last transaction's, are within it, so that it is overwritten and never grows: a
/// transaction has one page or two of 4,120 bytes each.
constexpr sqlite3_int64 kLogSize = 4 << 20;

/// quick_check reads the whole file. A ledger is some kilobytes; one past this is not checked, so that
/// start-up stays short.
constexpr std::int64_t kMostChecked = 64 << 20;

Failure system_error(const std::string& doing) {
  const int code = errno;
  return {{doing + ": " + std::strerror(code), code == ENOSPC || code == EDQUOT}};
}

/// Makes an empty file of mode 0600 where there is none; SQLite gives its -wal the same mode. True: it did.
Attempt<bool> make_file(const std::string& path) {
  const loop::FileDescriptor made(::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600));
  if (!made && errno != EEXIST) return std::unexpected(system_error("making " + path));
  if (!made && ::chmod(path.c_str(), 0600) != 0) return std::unexpected(system_error("chmod 0600 " + path));
  return static_cast<bool>(made);
}

/// A new or renamed file outlives a power cut only once its folder is on disk too.
Attempt<void> sync_folder(const std::string& folder) {
  const loop::FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened || ::fsync(opened.get()) != 0) return std::unexpected(system_error("syncing " + folder));
  return {};
}

Attempt<void> check_pages(Database& database) {
  const auto pages = database.number("PRAGMA page_count");
  if (!pages) return std::unexpected(pages.error());
  const auto page_size = database.number("PRAGMA page_size");
  if (!page_size) return std::unexpected(page_size.error());
  if (*pages * *page_size > kMostChecked) return {};
  const auto verdict = database.text("PRAGMA quick_check(1)");
  if (!verdict) return std::unexpected(verdict.error());
  if (*verdict != "ok") return std::unexpected(Failure{{*verdict}, true});
  return {};
}

/// Fills the write-ahead log up with zeros, which SQLite takes for its end. Where there is no room for that
/// it grows as it is written.
void reserve_log(Database& database) {
  sqlite3_file* const log = database.log();
  sqlite3_int64 size = 0;
  if (log == nullptr || log->pMethods->xFileSize(log, &size) != SQLITE_OK) return;
  const std::vector<char> zeros(64 << 10);
  for (; size < kLogSize; size += static_cast<sqlite3_int64>(zeros.size())) {
    const auto length = std::min<sqlite3_int64>(kLogSize - size, static_cast<sqlite3_int64>(zeros.size()));
    if (log->pMethods->xWrite(log, zeros.data(), static_cast<int>(length), size) != SQLITE_OK) break;
  }
  log->pMethods->xSync(log, SQLITE_SYNC_NORMAL);
}

Attempt<void> set_up(Database& database) {
  if (auto set = database.execute(kPragmas); !set) return set;
  if (auto known = check_version(database); !known) return known;
  const auto mode = database.text("PRAGMA journal_mode = WAL");
  if (!mode) return std::unexpected(mode.error());
  if (*mode != "wal") return std::unexpected(Failure{{"the ledger's file system has no WAL: " + *mode}});
  if (auto pages = check_pages(database); !pages) return pages;
  if (auto made = make_tables(database); !made) return made;
  reserve_log(database);
  return {};
}

/// Renames the file and what SQLite keeps beside it to the first `damaged-<n>` that is free.
Attempt<std::string> set_aside(const std::string& folder, const std::string& path) {
  for (int n = 1;; ++n) {
    std::string aside = path + ".damaged-" + std::to_string(n);
    if (::renameat2(AT_FDCWD, path.c_str(), AT_FDCWD, aside.c_str(), RENAME_NOREPLACE) != 0) {
      if (errno == EEXIST) continue;
      return std::unexpected(system_error("setting aside " + path));
    }
    for (const char* suffix : {"-wal", "-shm", "-journal"}) {
      const bool moved = ::rename((path + suffix).c_str(), (aside + suffix).c_str()) == 0;
      // One left behind would be taken for the new file's.
      if (!moved && errno != ENOENT) return std::unexpected(system_error("setting aside " + path + suffix));
    }
    if (auto synced = sync_folder(folder); !synced) return std::unexpected(synced.error());
    return aside;
  }
}

/// A ledger that is there, but with nothing in it, nor a log beside it: what it held is lost. (One that was
/// just being made when the box lost its power looks the same.)
bool is_blank(const std::string& path) {
  struct stat log{};
  if (::stat((path + "-wal").c_str(), &log) == 0 && log.st_size > 0) return false;
  const loop::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) return false;
  char head[72] = {};
  const ssize_t length = ::pread(file.get(), head, sizeof head, 0);
  constexpr int kApplicationAt = 68;  // of SQLite's file header
  return length == 0 || (length == sizeof head && std::string_view(head, 15) == "SQLite format 3" &&
                         std::string_view(head + kApplicationAt, 4) == std::string_view("\0\0\0\0", 4));
}

Attempt<Database> open_file(const std::string& path) {
  const auto made = make_file(path);
  if (!made) return std::unexpected(made.error());
  auto database = Database::open(path);
  if (!database) return std::unexpected(database.error());
  if (auto ready = set_up(*database); !ready) {
    if (*made) ::unlink(path.c_str());  // an empty one would be taken for one that has lost what it held
    // The damaged file stays as it was found, for whoever looks into it.
    sqlite3_db_config(database->get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    return std::unexpected(std::move(ready.error()));
  }
  return std::move(*database);
}

}  // namespace

Attempt<Opened> open_database(const std::string& folder) {
  const std::string path = folder + "/ledger.sqlite";
  std::string damage;
  const bool blank = is_blank(path);
  auto database = open_file(path);
  if (database && blank) damage = "The ledger was empty: reports recorded before are not known.";
  if (!database && database.error().damaged) {
    const auto aside = set_aside(folder, path);
    if (!aside) return std::unexpected(aside.error());
    damage = "The ledger could not be read (" + database.error().what + ") and was set aside as " + *aside +
             "; reports recorded in it are not shown.";
    database = open_file(path);
  }
  if (!database) return std::unexpected(std::move(database.error()));
  if (auto synced = sync_folder(folder); !synced) return std::unexpected(synced.error());
  return Opened{std::move(*database), std::move(damage)};
}

}  // namespace adit::ledger
