#include "ledger/tables.hpp"

#include <string>
#include <utility>

#include "ledger/rows.hpp"

namespace adit::ledger {
namespace {

constexpr std::int64_t kApplicationId = 0x41444954;  // "ADIT", in SQLite's file header
constexpr std::int64_t kVersion = 5;                 // of the tables below, in user_version
/// A version that only adds to an earlier one's tables writes that one's number << 16 | its own, so that the
/// slot before an update can still work with its ledger. Versions 4 and 5 only add to version 3.
constexpr int kOldestAt = 16;
constexpr std::int64_t kVersionBits = 0xffff;

/// `history` is a row's own, not a table: a step is then one row of one page to write.
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
    history TEXT NOT NULL,
    CHECK((before_score IS NULL) + (before_run_clock IS NULL) + (before_remaining_reports IS NULL)
      + (before_current_team IS NULL) IN (0, 4))) STRICT;
  CREATE TABLE run(
    number INTEGER PRIMARY KEY CHECK(number > 0),
    id TEXT NOT NULL, began REAL NOT NULL, why TEXT NOT NULL,
    score INTEGER, run_clock REAL, remaining_reports INTEGER, current_team TEXT,
    heard REAL NOT NULL, post TEXT NOT NULL, unreliable TEXT NOT NULL,
    CHECK((score IS NULL) + (run_clock IS NULL) + (remaining_reports IS NULL) + (current_team IS NULL)
      IN (0, 4))) STRICT;
  PRAGMA application_id = 0x41444954;
)";

/// What version 4 adds: a proof in each row (1: none; 0 is what a page reads as that was cut off), the mark
/// (mark.hpp), and what tells a run from another, which is not in `run`, as version 3 writes that. Where
/// somebody writes a row again who knows no proofs, the one that was in it is none any more.
constexpr const char* kAddProofs = R"(
  ALTER TABLE report ADD COLUMN proof INTEGER NOT NULL DEFAULT 1;
  ALTER TABLE run ADD COLUMN proof INTEGER NOT NULL DEFAULT 1;
  CREATE TABLE mark(
    number INTEGER PRIMARY KEY CHECK(number = 1),
    log_needed INTEGER NOT NULL, log_size INTEGER NOT NULL, highest INTEGER NOT NULL,
    proof INTEGER NOT NULL) STRICT;
  CREATE TABLE sighting(
    number INTEGER PRIMARY KEY CHECK(number > 0),
    turn INTEGER NOT NULL, may_be INTEGER NOT NULL,
    status_clock REAL, status_clock_runs INTEGER NOT NULL,
    answer_clock REAL, answer_clock_runs INTEGER NOT NULL,
    heard REAL NOT NULL, proof INTEGER NOT NULL) STRICT;
  CREATE TRIGGER report_without_proof AFTER UPDATE ON report WHEN NEW.proof IS OLD.proof
    BEGIN UPDATE report SET proof = 1 WHERE number = NEW.number; END;
  CREATE TRIGGER run_without_proof AFTER UPDATE ON run WHEN NEW.proof IS OLD.proof
    AND (NEW.id, NEW.began, NEW.why, NEW.score, NEW.run_clock, NEW.remaining_reports, NEW.current_team,
      NEW.heard, NEW.post, NEW.unreliable) IS NOT (OLD.id, OLD.began, OLD.why, OLD.score, OLD.run_clock,
      OLD.remaining_reports, OLD.current_team, OLD.heard, OLD.post, OLD.unreliable)
    BEGIN UPDATE run SET proof = 1 WHERE number = NEW.number; END;
)";

/// What version 5 adds: the robots that reports name. Not in `report`, of which version 4 proves each column
/// that it knows and no other.
constexpr const char* kAddRobots = R"(
  CREATE TABLE robot(
    number INTEGER PRIMARY KEY CHECK(number > 0),
    name TEXT NOT NULL, proof INTEGER NOT NULL) STRICT;
  PRAGMA user_version = 196613; -- 3 << 16 | 5
)";

/// Versions 1 and 2 had a table `step`, of report, at, state and note, in the order of its rows. Version 1
/// numbered the reports itself, and knew less of them and nothing of runs.
constexpr const char* kSetAside[] = {
    "", "ALTER TABLE report RENAME TO old_report",
    "ALTER TABLE report RENAME TO old_report; ALTER TABLE run RENAME TO old_run"};
constexpr const char* kTakeOver[] = {"", R"(
  INSERT INTO report(number, type, x, y, z, sender, received, changed, state, note, status, content_type,
    answer, history)
  SELECT number, type, x, y, z, sender, received, changed, state, note, status, content_type, answer, coalesce((
    SELECT group_concat(line, '') FROM (
      SELECT at || ' ' || length(CAST(state AS BLOB)) || ':' || state || ' ' || length(CAST(note AS BLOB))
        || ':' || note || char(10) AS line
      FROM step WHERE report = number ORDER BY rowid)), '')
  FROM old_report;
  DROP TABLE step;
  DROP TABLE old_report;
)",
                                     R"(
  INSERT INTO report SELECT *, coalesce((
    SELECT group_concat(line, '') FROM (
      SELECT at || ' ' || length(CAST(state AS BLOB)) || ':' || state || ' ' || length(CAST(note AS BLOB))
        || ':' || note || char(10) AS line
      FROM step WHERE report = number ORDER BY rowid)), '')
  FROM old_report;
  INSERT INTO run SELECT * FROM old_run;
  DROP TABLE step;
  DROP TABLE old_report;
  DROP TABLE old_run;
)"};

/// What the file's header says it is; all are 0 in a new file.
struct Kind {
  std::int64_t application = 0;
  std::int64_t version = 0;
  std::int64_t oldest = 0;  // the version whose Adit can still work with these tables

  bool is_ledger() const { return application == kApplicationId; }
};

Result<Kind> kind_of(Database& database) {
  const auto application = database.number("PRAGMA application_id");
  if (!application) return std::unexpected(application.error());
  const auto version = database.number("PRAGMA user_version");
  if (!version) return std::unexpected(version.error());
  const std::int64_t oldest = *version >> kOldestAt;
  return Kind{*application, oldest > 0 ? *version & kVersionBits : *version, oldest > 0 ? oldest : *version};
}

std::unexpected<Error> no_ledger(std::string why) {
  return std::unexpected(Error{Error::Kind::Damaged, std::move(why)});
}

}  // namespace

Result<void> check_version(Database& database) {
  const auto kind = kind_of(database);
  if (!kind) return std::unexpected(kind.error());
  if (!kind->is_ledger()) {
    const auto tables = database.number("SELECT count(*) FROM sqlite_schema");
    if (!tables) return std::unexpected(tables.error());
    if (*tables != 0) return no_ledger("it is another program's database");
    return {};
  }
  const std::string version = "version " + std::to_string(kind->version);
  if (kind->version < 1) return no_ledger("it has " + version + ", which does not exist");
  if (kind->oldest > kind->version)
    return no_ledger("it has " + version + ", which only a later version can read");
  if (kind->oldest > kVersion) {
    std::string sentence = "a later Adit wrote this ledger (" + version + ", this Adit reads up to ";
    sentence += std::to_string(kVersion) + "); run that Adit, or move the ledger out of its directory";
    return std::unexpected(Error{.what = std::move(sentence)});
  }
  return {};
}

Result<void> make_tables(Database& database) {
  const auto kind = kind_of(database);
  if (!kind) return std::unexpected(kind.error());
  if (kind->is_ledger() && kind->version >= kVersion) return {};
  Transaction transaction(database);
  if (auto begun = transaction.begin(); !begun) return begun;
  const auto old = static_cast<std::size_t>(kind->is_ledger() ? kind->version : 0);
  const char* const set_aside = old < 3 ? kSetAside[old] : "";
  const char* const tables = old < 3 ? kTables : "";
  const char* const take_over = old < 3 ? kTakeOver[old] : "";
  const char* const proofs = old < 4 ? kAddProofs : "";
  for (const char* sql : {set_aside, tables, take_over, proofs, kAddRobots, kProveRows.c_str()}) {
    if (auto done = database.execute(sql); !done) return done;
  }
  return transaction.commit();
}

}  // namespace adit::ledger
