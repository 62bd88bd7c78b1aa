#include "ledger/database.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

namespace adit::ledger {
namespace {

/// SQLite reports a full disk as SQLITE_FULL where a write met it, and as an I/O error elsewhere (a quota, a
/// limit of the file's size, growing a file).
/// `system_error`: the errno behind it, or 0. SQLITE_ERROR says that a table or a column is not there.
Error::Kind kind_of(int code, int system_error) {
  switch (code) {
    case SQLITE_FULL:
      return Error::Kind::Full;
    case SQLITE_IOERR:
      if (system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG) return Error::Kind::Full;
      return Error::Kind::Failing;
    case SQLITE_READONLY:
      return Error::Kind::ReadOnly;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_ERROR:
      return Error::Kind::Damaged;
    default:
      return Error::Kind::Other;
  }
}

sqlite3_file* log_of(sqlite3* database) {
  sqlite3_file* log = nullptr;
  sqlite3_file_control(database, "main", SQLITE_FCNTL_JOURNAL_POINTER, static_cast<void*>(&log));
  return log != nullptr && log->pMethods != nullptr ? log : nullptr;
}

/// The errno behind an I/O error. A COMMIT does not hand it up, so the write-ahead log, which is what a
/// COMMIT writes, is asked for its own.
int errno_behind(sqlite3* database) {
  if (const int code = sqlite3_system_errno(database); code != 0) return code;
  sqlite3_file* const log = log_of(database);
  if (log == nullptr) return 0;
  int code = 0;
  log->pMethods->xFileControl(log, SQLITE_FCNTL_LAST_ERRNO, &code);
  return code;
}

}  // namespace

Result<Database> Database::open(const std::string& path, int flags) {
  Database database;
  sqlite3* handle = nullptr;
  // No mutexes: a ledger is used by one thread at a time.
  const int result = sqlite3_open_v2(path.c_str(), &handle, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  database.handle_.reset(handle);  // there to be closed also where opening failed
  if (result != SQLITE_OK) return std::unexpected(database.error("opening " + path));
  return database;
}

Result<void> Database::execute(const char* sql) {
  if (sqlite3_exec(get(), sql, nullptr, nullptr, nullptr) == SQLITE_OK) return {};
  return std::unexpected(error(sql));
}

Result<std::int64_t> Database::number(const char* sql) {
  const auto statement = Statement::prepare(*this, sql);
  if (!statement) return std::unexpected(statement.error());
  Query query(*statement);
  if (query.step() != SQLITE_ROW) return std::unexpected(error(sql));
  return query.number(0);
}

Result<std::string> Database::text(const char* sql) {
  const auto statement = Statement::prepare(*this, sql);
  if (!statement) return std::unexpected(statement.error());
  Query query(*statement);
  if (query.step() != SQLITE_ROW) return std::unexpected(error(sql));
  return query.bytes(0);
}

Error Database::error(std::string_view doing) const {
  if (get() == nullptr) return {Error::Kind::Other, std::string(doing) + ": out of memory"};
  const int code = sqlite3_errcode(get()) & 0xff;
  std::string what = std::string(doing) + ": " + sqlite3_errmsg(get());
  if (code == SQLITE_BUSY) what += ": another process has the ledger open";
  const int system_error = code == SQLITE_IOERR || code == SQLITE_CANTOPEN ? errno_behind(get()) : 0;
  if (system_error != 0) what += std::string(" (") + std::strerror(system_error) + ")";
  return {kind_of(code, system_error), std::move(what)};
}

sqlite3_file* Database::log() const {
  return log_of(get());
}

Result<Statement> Statement::prepare(const Database& database, const std::string& sql) {
  Statement statement;
  sqlite3_stmt* handle = nullptr;
  const int result =
      sqlite3_prepare_v3(database.get(), sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &handle, nullptr);
  statement.handle_.reset(handle);
  if (result != SQLITE_OK) return std::unexpected(database.error(sql));
  return statement;
}

Query::~Query() {
  sqlite3_reset(statement_);
}

void Query::keep(int result) {
  if (failed_ == SQLITE_OK) failed_ = result;
}

Query& Query::bind(std::int64_t value) {
  keep(sqlite3_bind_int64(statement_, ++bound_, value));
  return *this;
}

Query& Query::bind(double value) {
  keep(sqlite3_bind_double(statement_, ++bound_, value));
  return *this;
}

Query& Query::bind(std::string_view text) {
  // A null pointer would bind NULL.
  keep(sqlite3_bind_text64(statement_, ++bound_, text.empty() ? "" : text.data(), text.size(), SQLITE_STATIC,
                           SQLITE_UTF8));
  return *this;
}

Query& Query::bind_blob(std::string_view bytes) {
  keep(sqlite3_bind_blob64(statement_, ++bound_, bytes.empty() ? "" : bytes.data(), bytes.size(),
                           SQLITE_STATIC));
  return *this;
}

Query& Query::bind_null() {
  keep(sqlite3_bind_null(statement_, ++bound_));
  return *this;
}

int Query::step() {
  return failed_ != SQLITE_OK ? failed_ : sqlite3_step(statement_);
}

std::string Query::bytes(int column) const {
  const void* data = sqlite3_column_blob(statement_, column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
  return size == 0 ? std::string() : std::string(static_cast<const char*>(data), size);
}

Transaction::~Transaction() {
  const bool open = sqlite3_get_autocommit(database_.get()) == 0;
  if (open) sqlite3_exec(database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

Result<void> Transaction::run(Statement& statement, const char* sql) {
  if (statement.get() == nullptr) {
    auto prepared = Statement::prepare(database_, sql);
    if (!prepared) return std::unexpected(std::move(prepared.error()));
    statement = std::move(*prepared);
  }
  Query query(statement);
  if (query.step() != SQLITE_DONE) return std::unexpected(database_.error(sql));
  return {};
}

}  // namespace adit::ledger
