#include "ledger/tables.hpp"

#include <string>
#include <utility>

namespace adit::ledger {
namespace {

constexpr std::int64_t kApplicationId = 0x41444954;  // "ADIT", in SQLite's file header
constexpr std::int64_t kVersion = 2;                 // of the tables below, in user_version

/// `report` is each report as it is now, `step` is how it came there. There is no index on step(report): it
/// would cost every step another page, and a report's history is read only when somebody looks at it.
constexpr const char* kTables = R"(
  CREATE TABLE report(
    number INTEGER PRIMARY KEY CHECK(number > 0),
    type TEXT NOT NULL, x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL,
    sender TEXT NOT NULL, received REAL NOT NULL, changed REAL NOT NULL,
    state TEXT NOT NULL, note TEXT NOT NULL,
    run INTEGER NOT NULL DEFAULT 0, asked INTEGER NOT NULL DEFAULT 0, same_as INTEGER NOT NULL DEFAULT 0,
    tries INTEGER NOT NULL DEFAULT 0, sending INTEGER NOT NULL DEFAULT 0, sent REAL NOT NULL DEFAULT 0,
    before_score INTEGER, before_run_clock REAL, before_remaining_reports INTEGER, before_current_team TEXT,
    status INTEGER NOT NULL, content_type TEXT NOT NULL, answer BLOB NOT NULL,
    reconciled INTEGER NOT NULL DEFAULT 0,
    CHECK((before_score IS NULL) + (before_run_clock IS NULL) + (before_remaining_reports IS NULL)
      + (before_current_team IS NULL) IN (0, 4))) STRICT;
  CREATE TABLE step(
    report INTEGER NOT NULL REFERENCES report(number),
    at REAL NOT NULL, state TEXT NOT NULL, note TEXT NOT NULL) STRICT;
  CREATE TABLE run(
    number INTEGER PRIMARY KEY CHECK(number > 0),
    id TEXT NOT NULL, began REAL NOT NULL, why TEXT NOT NULL,
    score INTEGER, run_clock REAL, remaining_reports INTEGER, current_team TEXT,
    heard REAL NOT NULL, post TEXT NOT NULL, unreliable TEXT NOT NULL,
    CHECK((score IS NULL) + (run_clock IS NULL) + (remaining_reports IS NULL) + (current_team IS NULL)
      IN (0, 4))) STRICT;
  PRAGMA application_id = 0x41444954;
  PRAGMA user_version = 2;
)";

/// Version 1 had `report` and `step` alone, and numbered the reports itself.
constexpr const char* kBeforeVersion2 = R"(
  ALTER TABLE report RENAME TO report_1;
  ALTER TABLE step RENAME TO step_1;
)";
constexpr const char* kFromVersion1 = R"(
  INSERT INTO report(number, type, x, y, z, sender, received, changed, state, note, status, content_type, answer)
    SELECT number, type, x, y, z, sender, received, changed, state, note, status, content_type, answer
    FROM report_1;
  INSERT INTO step(report, at, state, note) SELECT report, at, state, note FROM step_1 ORDER BY rowid;
  DROP TABLE step_1;
  DROP TABLE report_1;
)";

/// What the file's header says it is; both are 0 in a new file.
struct Kind {
  std::int64_t application = 0;
  std::int64_t version = 0;

  bool is_ledger() const { return application == kApplicationId; }
};

Attempt<Kind> kind_of(Database& database) {
  const auto application = database.number("PRAGMA application_id");
  if (!application) return std::unexpected(application.error());
  const auto version = database.number("PRAGMA user_version");
  if (!version) return std::unexpected(version.error());
  return Kind{*application, *version};
}

std::unexpected<Failure> no_ledger(std::string why) {
  return std::unexpected(Failure{{std::move(why)}, true});
}

}  // namespace

Attempt<void> check_version(Database& database) {
  const auto kind = kind_of(database);
  if (!kind) return std::unexpected(kind.error());
  if (!kind->is_ledger()) {
    const auto tables = database.number("SELECT count(*) FROM sqlite_schema");
    if (!tables) return std::unexpected(tables.error());
    if (*tables != 0) return no_ledger("it is another program's database");
    return {};
  }
  const std::string version = "version " + std::to_string(kind->version);
  if (kind->version < 1) return no_ledger("it has " + version + ", which there never was");
  if (kind->version > kVersion) {
    std::string sentence = "a later Adit wrote this ledger (" + version + ", and this one reads up to ";
    sentence += std::to_string(kVersion) + "): run that Adit, or move the ledger out of its folder";
    return std::unexpected(Failure{{std::move(sentence)}, false});
  }
  return {};
}

Attempt<void> make_tables(Database& database) {
  const auto kind = kind_of(database);
  if (!kind) return std::unexpected(kind.error());
  if (kind->is_ledger() && kind->version == kVersion) return {};
  Transaction transaction(database);
  if (auto begun = transaction.begin(); !begun) return begun;
  for (const char* sql :
       {kind->is_ledger() ? kBeforeVersion2 : "", kTables, kind->is_ledger() ? kFromVersion1 : ""}) {
    if (auto done = database.execute(sql); !done) return done;
  }
  return transaction.commit();
}

}  // namespace adit::ledger
