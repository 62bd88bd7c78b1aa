#include "ledger/salvage.hpp"

#include <chrono>
#include <vector>

#include "dispatch/report.hpp"
#include "icd/sentence.hpp"
#include "ledger/rows.hpp"

namespace adit::ledger {
namespace {

constexpr std::size_t kSender = 5;               // the column
constexpr std::int64_t kNumbersKeptFree = 1000;  // the most that can have waited, at least
constexpr const char* kDamaged = "the ledger was damaged: the Command Post's earlier counts are not certain";

constexpr const char* kHold = R"(
  UPDATE report SET state = 'in doubt', changed = ?1, note = ?2, before_score = NULL, before_run_clock = NULL,
    before_remaining_reports = NULL, before_current_team = NULL, history = history || ?3, proof = 1
  WHERE state NOT IN ('answered', 'settled', 'withdrawn') AND sender != 'lost')";

constexpr const char* kStandIn = R"(
  INSERT INTO report(number, type, x, y, z, sender, received, changed, state, note, run, status, content_type,
    answer, history)
  VALUES(?1, '?', 0, 0, 0, 'lost', ?2, ?2, 'in doubt', ?3, (
    SELECT number FROM run LEFT JOIN sighting USING(number) ORDER BY max(coalesce(turn, 0), number) DESC LIMIT 1),
    0, '', x'', ?4))";

/// The present run is that of the latest report, where no row of it could be had. Any other may be taken up
/// again.
constexpr const char* kPresentRun = R"(
  INSERT OR IGNORE INTO run(number, id, began, why, heard, post, unreliable)
  SELECT max(1, coalesce((SELECT max(number) FROM run), 1), coalesce((SELECT max(run) FROM report), 1)), '', ?1,
    'the ledger was damaged', 0, '', '')";

constexpr const char* kDistrust = R"(
  UPDATE run SET unreliable = ?1, proof = 1
  WHERE unreliable = '')";

double now() {
  using std::chrono::system_clock;
  return std::chrono::duration<double>(system_clock::now().time_since_epoch()).count();
}

std::string step_of(double at, const std::string& note) {
  constexpr std::string_view kState = "in doubt";
  return icd::sentence(at, " ", kState.size(), ":", kState, " ", note.size(), ":", note, "\n");
}

void bind(Query& query, const Value& value) {
  if (const auto* const number = std::get_if<std::int64_t>(&value)) query.bind(*number);
  if (const auto* const real = std::get_if<double>(&value)) query.bind(*real);
  if (const auto* const text = std::get_if<std::string>(&value)) query.bind(*text);
  if (const auto* const blob = std::get_if<Blob>(&value)) query.bind_blob(blob->bytes);
  if (std::holds_alternative<std::monostate>(value)) query.bind_null();
}

/// Numbers from one to another that are nobody's.
struct Gap {
  std::int64_t from = 0, to = 0;
};

/// "report 7 is", "reports 7 to 9 are"
std::string subject(const Gap& gap) {
  return gap.from == gap.to ? icd::sentence("report ", gap.to, " is")
                            : icd::sentence("reports ", gap.from, " to ", gap.to, " are");
}

class Salvage {
 public:
  Salvage(Database& database, const Carved& carved) : database_(database), carved_(carved), now_(now()) {}

  Result<std::string> run(bool tail_lost) {
    Transaction transaction(database_);
    if (auto begun = transaction.begin(); !begun) return std::unexpected(begun.error());
    if (auto copied = copy("report", carved_.reports); !copied) return std::unexpected(copied.error());
    if (auto copied = copy("run", carved_.runs); !copied) return std::unexpected(copied.error());
    if (auto copied = copy("sighting", carved_.sightings); !copied) return std::unexpected(copied.error());
    if (auto copied = copy("robot", carved_.robots); !copied) return std::unexpected(copied.error());
    if (auto held = hold(); !held) return std::unexpected(held.error());
    std::string missing;
    for (const Gap& gap : gaps()) {
      const std::string said = subject(gap) + " lost from the ledger";
      if (auto stands = stand_in(gap.to, said + ": it may have been sent"); !stands) {
        return std::unexpected(stands.error());
      }
      missing += (missing.empty() ? "" : ", ") + said;
    }
    if (tail_lost) {
      const std::int64_t last = next_number() / kNumbersKeptFree * kNumbersKeptFree + kNumbersKeptFree;
      const std::string said =
          icd::sentence("reports from ", next_number(), " on may be lost from the ledger");
      if (auto stands = stand_in(last, said + ": they may have been sent"); !stands) {
        return std::unexpected(stands.error());
      }
      missing += (missing.empty() ? "" : ", ") + said;
    }
    if (auto proven = database_.execute(kProveRows.c_str()); !proven) return std::unexpected(proven.error());
    if (auto committed = transaction.commit(); !committed) return std::unexpected(committed.error());
    return icd::sentence(carved_.reports.size(), " reports were copied to a new ledger",
                         missing.empty() ? "" : "; " + missing);
  }

 private:
  Result<void> copy(const std::string& table, const std::map<std::int64_t, Row>& rows) {
    if (rows.empty()) return {};
    std::string sql = "INSERT INTO " + table + " VALUES(";
    for (std::size_t i = 0; i < rows.begin()->second.size(); ++i) sql += "?, ";
    const auto statement = Statement::prepare(database_, (sql + "1)").c_str());
    if (!statement) return std::unexpected(statement.error());
    for (const auto& [number, row] : rows) {
      Query query(*statement);
      for (const Value& value : row) bind(query, value);
      if (query.step() != SQLITE_DONE) return std::unexpected(database_.error("copying " + table));
    }
    return {};
  }

  template <class... Values>
  Result<void> change(const char* sql, const Values&... values) {
    const auto statement = Statement::prepare(database_, sql);
    if (!statement) return std::unexpected(statement.error());
    Query query(*statement);
    (query.bind(values), ...);
    if (query.step() != SQLITE_DONE) return std::unexpected(database_.error("recovering the ledger"));
    return {};
  }

  Result<void> hold() {
    const std::string note = "the ledger was damaged: it may have been sent since; the operator decides";
    if (auto there = change(kPresentRun, now_); !there) return there;
    if (auto distrusted = change(kDistrust, std::string_view(kDamaged)); !distrusted) return distrusted;
    return change(kHold, now_, note, step_of(now_, note));
  }

  Result<void> stand_in(std::int64_t number, const std::string& note) {
    return change(kStandIn, number, now_, note, step_of(now_, note));
  }

  std::int64_t last_number() const {
    const std::int64_t last = carved_.reports.empty() ? 0 : carved_.reports.rbegin()->first;
    return std::max(last, carved_.highest.value_or(0));
  }
  std::int64_t next_number() const { return last_number() + 1; }

  /// One that stands for others already leaves no gap before it.
  std::vector<Gap> gaps() const {
    std::vector<Gap> found;
    std::int64_t next = 1;
    for (const auto& [number, row] : carved_.reports) {
      const bool stands_for_others = std::get<std::string>(row[kSender]) == dispatch::Report::kLost;
      if (number > next && !stands_for_others) found.push_back({next, number - 1});
      next = number + 1;
    }
    if (next <= last_number()) found.push_back({next, last_number()});
    return found;
  }

  Database& database_;
  const Carved& carved_;
  const double now_;
};

}  // namespace

Result<std::string> salvage(Database& database, const Carved& carved, bool tail_lost) {
  return Salvage(database, carved).run(tail_lost);
}

}  // namespace adit::ledger
