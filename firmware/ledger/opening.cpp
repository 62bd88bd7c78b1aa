#include "ledger/opening.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ledger/carving.hpp"
#include "ledger/files.hpp"
#include "ledger/log_file.hpp"
#include "ledger/mark.hpp"
#include "ledger/proof.hpp"
#include "ledger/rows.hpp"
#include "ledger/salvage.hpp"
#include "ledger/tables.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::ledger {
namespace {

/// One process owns the ledger, so its lock is exclusive; that also keeps WAL's index out of a shared file.
/// The log is taken over by take_over_log().
constexpr const char* kPragmas = R"(
  PRAGMA locking_mode = EXCLUSIVE;
  PRAGMA cell_size_check = ON;
  PRAGMA trusted_schema = OFF;
  PRAGMA synchronous = FULL;
  PRAGMA wal_autocheckpoint = 0;
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

Error damaged(std::string what) {
  return {Error::Kind::Damaged, std::move(what)};
}

Result<void> check_pages(Database& database) {
  const auto pages = database.number("PRAGMA page_count");
  if (!pages) return std::unexpected(pages.error());
  const auto page_size = database.number("PRAGMA page_size");
  if (!page_size) return std::unexpected(page_size.error());
  if (*pages * *page_size > kMostChecked) return {};
  const auto sound = database.text("PRAGMA quick_check(1)");
  if (!sound) return std::unexpected(sound.error());
  if (*sound != "ok") return std::unexpected(damaged(*sound));
  return {};
}

/// A row may have been changed so that it is still a row: only its proof tells.
Result<void> check_rows(Database& database) {
  const auto unproven = database.text(kUnprovenRow.c_str());
  if (!unproven) return std::unexpected(database.error("reading all rows"));
  if (!unproven->empty()) return std::unexpected(damaged(*unproven + " is damaged"));
  for (const std::string* sql :
       {&kWriteReport, &kWriteRun, &kWriteSighting, &kWriteRobot, &kReadReports, &kReadHistory, &kReadRuns}) {
    if (const auto known = Statement::prepare(database, *sql); !known) return std::unexpected(known.error());
  }
  return database.execute(kProveRows.c_str());
}

/// Fills the write-ahead log up with zeros, which SQLite takes for its end. Where there is no room for that
/// it grows as it is written. Gives its size then, 0 where it grows.
sqlite3_int64 reserve_log(Database& database) {
  sqlite3_file* const log = database.log();
  sqlite3_int64 size = 0;
  if (log == nullptr || log->pMethods->xFileSize(log, &size) != SQLITE_OK) return 0;
  const std::vector<char> zeros(64 << 10);
  for (; size < kLogSize; size += static_cast<sqlite3_int64>(zeros.size())) {
    const auto length = std::min<sqlite3_int64>(kLogSize - size, static_cast<sqlite3_int64>(zeros.size()));
    if (log->pMethods->xWrite(log, zeros.data(), static_cast<int>(length), size) != SQLITE_OK) return 0;
  }
  return log->pMethods->xSync(log, SQLITE_SYNC_NORMAL) == SQLITE_OK ? kLogSize : 0;
}

/// A ledger may be used also where there is no room for its mark; one that SQLite will not write to may not.
Result<void> begin_log(Database& database) {
  const sqlite3_int64 size = reserve_log(database);
  if (auto marked = write_mark(database, true, size); !marked) {
    if (marked.error().kind == Error::Kind::ReadOnly) return marked;
    return {};
  }
  sqlite3_wal_checkpoint_v2(database.get(), nullptr, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr);
  (void)write_mark(database, false, size);
  return {};
}

Result<void> set_up(Database& database) {
  if (!database.execute(kPragmas)) return std::unexpected(database.error("opening the ledger"));
  if (auto taught = teach_proof(database); !taught) return taught;
  if (auto known = check_version(database); !known) return known;
  const auto tables = database.number("SELECT count(*) FROM sqlite_schema");
  if (!tables) return std::unexpected(tables.error());
  // A new one gets its name only when it is whole.
  if (*tables == 0) return std::unexpected(damaged("the file is empty"));
  const auto mode = database.text("PRAGMA journal_mode = WAL");
  if (!mode) return std::unexpected(mode.error());
  if (*mode != "wal")
    return std::unexpected(Error{.what = "the ledger's file system does not support WAL: " + *mode});
  if (auto pages = check_pages(database); !pages) return pages;
  if (auto made = make_tables(database); !made) return made;
  if (auto rows = check_rows(database); !rows) return rows;
  return begin_log(database);
}

class Opening {
 public:
  explicit Opening(const std::string& folder)
      : folder_(folder),
        path_(folder + "/ledger.sqlite"),
        new_(path_ + ".new"),
        salvaged_(path_ + ".salvaged") {}

  Result<Opened> open() {
    if (auto writable = try_writing(folder_); !writable) return std::unexpected(writable.error());
    for (const char* suffix : {"", "-wal", "-shm", "-journal", ".salvaged"}) {
      if (auto regular = check_regular(path_ + suffix); !regular) return std::unexpected(regular.error());
    }
    if (auto there = have_file(); !there) return std::unexpected(there.error());
    auto database = open_file();
    if (!database && database.error().kind == Error::Kind::Damaged) {
      // What a log says that was put right is known for certain only where all rows prove it.
      tail_lost_ = tail_lost_ || repaired_;
      if (auto done = salvage_files(database.error().what); !done) return std::unexpected(done.error());
      tail_lost_ = repaired_ = false;
      database = open_file();
    }
    if (!database) return std::unexpected(std::move(database.error()));
    if (auto synced = sync_folder(folder_); !synced) return std::unexpected(synced.error());
    return Opened{std::move(*database), std::move(damage_)};
  }

 private:
  /// A ledger under its name: the one that was salvaged when the box died, or a new one.
  Result<void> have_file() {
    if (exists(salvaged_)) {
      damage_ =
          "The ledger was damaged. Its file was renamed, and all readable reports were copied to a new "
          "ledger.";
      return put_salvaged_in_place();
    }
    if (exists(path_)) return {};
    if (auto made = make_new(nullptr); !made) return made;
    if (exists(path_ + "-wal")) {  // of a ledger that is gone
      if (auto aside = set_aside(folder_, path_); !aside) return std::unexpected(aside.error());
    }
    if (auto named = rename_file(new_, path_); !named) return named;
    return sync_folder(folder_);
  }

  /// A whole ledger under its first name: empty, or with what was carved.
  Result<void> make_new(const Carved* carved) {
    remove_database(new_);
    auto made = make_file(new_);
    if (made) made = fill_new(carved);
    if (!made) remove_database(new_);
    return made;
  }

  Result<void> fill_new(const Carved* carved) {
    auto database = Database::open(new_);
    if (!database) return std::unexpected(database.error());
    if (auto set = database->execute("PRAGMA synchronous = FULL"); !set) return set;
    if (auto taught = teach_proof(*database); !taught) return taught;
    if (auto made = make_tables(*database); !made) return made;
    if (carved == nullptr) return {};
    auto sentence = salvage(*database, *carved, tail_lost_ || !carved->highest || carved->unproven);
    if (!sentence) return std::unexpected(sentence.error());
    taken_over_ = *std::move(sentence);
    return {};
  }

  Result<Database> open_file() {
    if (auto log = look_at_log(); !log) return std::unexpected(log.error());
    auto database = Database::open(path_);
    if (!database) return std::unexpected(database.error());
    if (::chmod(path_.c_str(), 0600) != 0) return std::unexpected(system_error("chmod 0600 " + path_));
    if (auto ready = set_up(*database); !ready) {
      // The damaged file stays as it was found, for whoever looks into it; its log with what was put right.
      sqlite3_db_config(database->get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
      // Its folder takes a write: that SQLite may not write is what the file's own header says.
      if (ready.error().kind == Error::Kind::ReadOnly)
        return std::unexpected(damaged(std::move(ready.error().what)));
      return std::unexpected(std::move(ready.error()));
    }
    return std::move(*database);
  }

  /// Before SQLite does, which says nothing of what it does not take.
  Result<void> look_at_log() {
    auto log = read_file(path_ + "-wal");
    if (!log) return std::unexpected(log.error());
    const LogReading reading = read_log(*log);
    std::string lost = reading.damage;
    const auto mark = mark_without_log(path_);
    if (mark && *mark && (*mark)->log_needed) {
      const bool cut = static_cast<std::int64_t>(log->size()) < (*mark)->log_size && !reading.ended;
      if (lost.empty() && reading.empty) lost = "the file is missing";
      if (lost.empty() && cut) lost = "the file was cut short";
    }
    if (lost.empty() && !mark && !reading.ended)
      lost = "its end is missing, and the ledger's mark is damaged";
    if (!lost.empty()) {
      tail_lost_ = true;
      return std::unexpected(damaged("its log: " + lost));
    }
    return repair_log(reading.repairs);
  }

  Result<void> repair_log(const std::vector<LogReading::Repair>& repairs) {
    if (repairs.empty()) return {};
    const std::string path = path_ + "-wal";
    const loop::FileDescriptor file = loop::open_regular(path, O_WRONLY);
    if (!file) return std::unexpected(system_error("repairing " + path));
    for (const auto& [at, byte] : repairs) {
      if (::pwrite(file.get(), &byte, 1, static_cast<off_t>(at)) != 1) {
        return std::unexpected(system_error("repairing " + path));
      }
    }
    if (::fdatasync(file.get()) != 0) return std::unexpected(system_error("repairing " + path));
    repaired_ = true;
    damage_ =
        "The ledger's log was damaged and was repaired by its checksums: " + std::to_string(repairs.size()) +
        " bytes. No report is missing.";
    return {};
  }

  /// Row by row, into a new ledger; the damaged one is kept aside.
  Result<void> salvage_files(const std::string& why) {
    const auto file = read_file(path_);
    if (!file) return std::unexpected(file.error());
    auto log = read_file(path_ + "-wal");
    if (!log) return std::unexpected(log.error());
    (void)read_log(*log);  // which puts right what it can
    const Carved carved = carve(*file, *log);
    if (auto made = make_new(&carved); !made) return made;
    if (auto named = rename_file(new_, salvaged_); !named) return named;
    if (auto synced = sync_folder(folder_); !synced) return synced;
    if (auto placed = put_salvaged_in_place(); !placed) return placed;
    damage_ = "The ledger was damaged (" + why + "). Its file is now " + aside_ + "; " + taken_over_ + ".";
    return {};
  }

  Result<void> put_salvaged_in_place() {
    auto aside = set_aside(folder_, path_);
    if (!aside) return std::unexpected(aside.error());
    aside_ = *std::move(aside);
    if (auto named = rename_file(salvaged_, path_); !named) return named;
    return sync_folder(folder_);
  }

  const std::string folder_, path_;
  const std::string new_;       // where one is made
  const std::string salvaged_;  // where one is that is whole, and that is to take the damaged one's place
  std::string damage_, aside_, taken_over_;
  bool tail_lost_ = false;  // what came last cannot be told from the files
  bool repaired_ = false;   // the log was put right by its checksums, of which several bytes may be the cause
};

}  // namespace

/// Where SQLite can make no file, it says that there is none: the folder itself is asked for the reason,
/// which may have come up since the opening began.
Result<Opened> open_database(const std::string& folder) {
  auto opened = Opening(folder).open();
  if (opened || opened.error().kind == Error::Kind::Full) return opened;
  const auto room = try_room(folder, 0);
  if (!room && room.error().kind != Error::Kind::Other) opened.error().kind = room.error().kind;
  return opened;
}

bool take_over_log(Database& database) {
  sqlite3_int64 size = 0;
  sqlite3_file* const log = database.log();
  if (log == nullptr || log->pMethods->xFileSize(log, &size) != SQLITE_OK) return false;
  if (!write_mark(database, true, size >= kLogSize ? kLogSize : 0)) return false;
  int pages = 0, taken = -1;
  const int result =
      sqlite3_wal_checkpoint_v2(database.get(), nullptr, SQLITE_CHECKPOINT_PASSIVE, &pages, &taken);
  (void)write_mark(database, false, size >= kLogSize ? kLogSize : 0);
  return result == SQLITE_OK && taken == pages;
}

}  // namespace adit::ledger
