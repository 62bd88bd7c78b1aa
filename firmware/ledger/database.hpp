#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "ledger/ledger.hpp"

namespace adit::ledger {

/// Why something could not be done, and whether the file itself is to blame: no database, or a damaged one.
struct Failure : Error {
  bool damaged = false;
};
template <class T>
using Attempt = std::expected<T, Failure>;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// A SQLite connection whose failures are sentences.
class Database {
 public:
  /// Opens a file that exists.
  static Attempt<Database> open(const std::string& path);

  Attempt<void> execute(const char* sql);
  /// The first column of the first row, as a number and as text.
  Attempt<std::int64_t> number(const char* sql);
  Attempt<std::string> text(const char* sql);

  /// What the last call failed with; `doing` begins its sentence ("recording a report").
  Failure error(std::string_view doing) const;
  sqlite3* get() const { return handle_.get(); }

 private:
  std::unique_ptr<sqlite3, CloseDatabase> handle_;
};

/// A prepared statement, kept for the life of the ledger. Use it through a Run.
class Statement {
 public:
  static Attempt<Statement> prepare(const Database& database, const char* sql);
  sqlite3_stmt* get() const { return handle_.get(); }

 private:
  std::unique_ptr<sqlite3_stmt, FinalizeStatement> handle_;
};

/// One run of a statement: bind its parameters in order, step, read columns from 0. Its end resets the
/// statement. A binding that failed makes the first step() fail.
class Run {
 public:
  explicit Run(const Statement& statement) : statement_(statement.get()) {}
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  Run& bind(std::int64_t value);
  Run& bind(double value);
  Run& bind(std::string_view text);
  Run& bind_blob(std::string_view bytes);

  /// SQLITE_ROW, SQLITE_DONE, or an error code.
  int step();

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

  Attempt<void> begin() { return database_.execute("BEGIN IMMEDIATE"); }
  Attempt<void> commit() { return database_.execute("COMMIT"); }

 private:
  Database& database_;
};

}  // namespace adit::ledger
