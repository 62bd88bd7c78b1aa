#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "ledger/ledger.hpp"

namespace adit::ledger {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// A prepared statement, kept for the life of its database. Use it through a Query.
class Statement {
 public:
  static Result<Statement> prepare(const class Database& database, const std::string& sql);
  sqlite3_stmt* get() const { return handle_.get(); }

 private:
  std::unique_ptr<sqlite3_stmt, FinalizeStatement> handle_;
};

/// A SQLite connection whose failures are sentences.
class Database {
 public:
  /// Opens a file that exists.
  static Result<Database> open(const std::string& path, int flags = SQLITE_OPEN_READWRITE);

  Result<void> execute(const char* sql);
  /// The first column of the first row, as a number and as text.
  Result<std::int64_t> number(const char* sql);
  Result<std::string> text(const char* sql);

  /// What the last call failed with; `doing` begins its sentence ("recording a report").
  Error error(std::string_view doing) const;
  sqlite3* get() const { return handle_.get(); }
  /// The write-ahead log, once something was read from or written to the database; else null.
  sqlite3_file* log() const;

 private:
  friend class Transaction;
  std::unique_ptr<sqlite3, CloseDatabase> handle_;
  Statement begin_, commit_;  // after the handle, which outlives them
};

/// One run of a statement: bind all of its parameters in order, step, read columns from 0. What is bound must
/// outlive it. Its end resets the statement. A binding that failed makes the first step() fail.
class Query {
 public:
  explicit Query(const Statement& statement) : statement_(statement.get()) {}
  ~Query();
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  Query& bind(std::int64_t value);
  Query& bind(double value);
  Query& bind(std::string_view text);
  Query& bind_blob(std::string_view bytes);
  Query& bind_null();

  /// SQLITE_ROW, SQLITE_DONE, or an error code.
  int step();

  bool is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }
  std::int64_t number(int column) const { return sqlite3_column_int64(statement_, column); }
  double real(int column) const { return sqlite3_column_double(statement_, column); }
  /// Text or blob, byte for byte.
  std::string bytes(int column) const;

 private:
  void keep(int result);

  sqlite3_stmt* statement_;
  int bound_ = 0;
  int failed_ = SQLITE_OK;
};

/// Undone at its end unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) {}
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  Result<void> begin() { return run(database_.begin_, "BEGIN IMMEDIATE"); }
  Result<void> commit() { return run(database_.commit_, "COMMIT"); }

 private:
  Result<void> run(Statement& statement, const char* sql);

  Database& database_;
};

}  // namespace adit::ledger
