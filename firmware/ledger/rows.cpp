#include "ledger/rows.hpp"

#include <charconv>

#include "icd/sentence.hpp"

namespace adit::ledger {

// The order of the columns in a statement is that of the bindings, and of the readings, below it; in a proof
// it is that of the table.

const char* const kWriteReport = R"(
  INSERT INTO report(number, type, x, y, z, sender, received, changed, state, note, run, asked, same_as,
    tries, sending, sent, before_score, before_run_clock, before_remaining_reports, before_current_team,
    status, content_type, answer, reconciled, history, proof)
  VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21, ?22,
    ?23, ?24, ?25,
    proof(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21, ?22,
      ?23, ?24, ?25))
  ON CONFLICT(number) DO UPDATE SET
    sender = excluded.sender, changed = excluded.changed, state = excluded.state, note = excluded.note,
    run = excluded.run, asked = excluded.asked, same_as = excluded.same_as, tries = excluded.tries,
    sending = excluded.sending, sent = excluded.sent, before_score = excluded.before_score,
    before_run_clock = excluded.before_run_clock,
    before_remaining_reports = excluded.before_remaining_reports,
    before_current_team = excluded.before_current_team, status = excluded.status,
    content_type = excluded.content_type, answer = excluded.answer, reconciled = excluded.reconciled,
    history = history || excluded.history,
    proof = proof(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21,
      ?22, ?23, ?24, history || excluded.history)
  WHERE type = excluded.type AND x = excluded.x AND y = excluded.y AND z = excluded.z
    AND received = excluded.received)";

const char* const kReadReports = R"(
  SELECT number, type, x, y, z, sender, received, changed, state, note, run, asked, same_as,
    tries, sending, sent, before_score, before_run_clock, before_remaining_reports, before_current_team,
    status, content_type, answer, reconciled
  FROM report ORDER BY number)";

const char* const kReadHistory = "SELECT history FROM report WHERE number = ?";

const char* const kWriteRun = R"(
  INSERT INTO run(number, id, began, why, score, run_clock, remaining_reports, current_team, heard, post,
    unreliable, proof)
  VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, proof(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11))
  ON CONFLICT(number) DO UPDATE SET
    id = excluded.id, began = excluded.began, why = excluded.why, score = excluded.score,
    run_clock = excluded.run_clock, remaining_reports = excluded.remaining_reports,
    current_team = excluded.current_team, heard = excluded.heard, post = excluded.post,
    unreliable = excluded.unreliable, proof = excluded.proof)";

const char* const kWriteSighting = R"(
  REPLACE INTO sighting(number, turn, may_be, status_clock, status_clock_runs, answer_clock, answer_clock_runs,
    heard, proof)
  VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, proof(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)))";

const char* const kReadRuns = R"(
  SELECT number, id, began, why, score, run_clock, remaining_reports, current_team, run.heard, post, unreliable,
    coalesce(turn, 0), coalesce(may_be, 0), status_clock, status_clock_runs, answer_clock, answer_clock_runs
  FROM run LEFT JOIN sighting USING(number) ORDER BY number)";

const char* const kProveRows = R"(
  UPDATE report SET proof = proof(number, type, x, y, z, sender, received, changed, state, note, run, asked,
    same_as, tries, sending, sent, before_score, before_run_clock, before_remaining_reports,
    before_current_team, status, content_type, answer, reconciled, history) WHERE proof = 1;
  UPDATE run SET proof = proof(number, id, began, why, score, run_clock, remaining_reports, current_team,
    heard, post, unreliable) WHERE proof = 1;
  UPDATE sighting SET proof = proof(number, turn, may_be, status_clock, status_clock_runs, answer_clock,
    answer_clock_runs, heard) WHERE proof = 1)";

const char* const kUnprovenRow = R"(
  SELECT 'report ' || number FROM report WHERE proof NOT IN (1, proof(number, type, x, y, z, sender, received,
    changed, state, note, run, asked, same_as, tries, sending, sent, before_score, before_run_clock,
    before_remaining_reports, before_current_team, status, content_type, answer, reconciled, history))
  UNION ALL SELECT 'run ' || number FROM run WHERE proof NOT IN (1, proof(number, id, began, why, score,
    run_clock, remaining_reports, current_team, heard, post, unreliable))
  UNION ALL SELECT 'what was seen of run ' || number FROM sighting WHERE proof NOT IN (1, proof(number, turn,
    may_be, status_clock, status_clock_runs, answer_clock, answer_clock_runs, heard))
  UNION ALL SELECT 'the mark' FROM mark WHERE proof != proof(number, log_needed, log_size, highest)
  UNION ALL SELECT 'report ' || highest FROM mark
    WHERE highest > (SELECT coalesce(max(number), 0) FROM report)
  UNION ALL SELECT '' LIMIT 1)";

namespace {

/// The columns of a row, one after the other.
class Columns {
 public:
  explicit Columns(const Query& row) : row_(row) {}

  std::int64_t number() { return row_.number(next_++); }
  double real() { return row_.real(next_++); }
  std::string bytes() { return row_.bytes(next_++); }
  bool flag() { return number() != 0; }

  /// What it shows, NULL where none was seen, and whether it runs.
  std::optional<dispatch::Clock> clock() {
    const bool none = row_.is_null(next_);
    const double shows = real();
    const bool runs = flag();
    if (none) return std::nullopt;
    return dispatch::Clock{.shows = shows, .runs = runs};
  }

  /// The four columns of a status; all of them are NULL where there is none.
  std::optional<icd::RunStatus> status() {
    const bool none = row_.is_null(next_);
    icd::RunStatus status;
    status.score = number();
    status.run_clock = real();
    status.remaining_reports = number();
    status.current_team = bytes();
    if (none) return std::nullopt;
    return status;
  }

 private:
  const Query& row_;
  int next_ = 0;
};

void bind_status(Query& query, const std::optional<icd::RunStatus>& status) {
  if (status) {
    query.bind(status->score).bind(status->run_clock).bind(status->remaining_reports);
    query.bind(status->current_team);
  } else {
    query.bind_null().bind_null().bind_null().bind_null();
  }
}

void bind_clock(Query& query, const std::optional<dispatch::Clock>& clock) {
  if (clock) {
    query.bind(clock->shows).bind(std::int64_t{clock->runs});
  } else {
    query.bind_null().bind(std::int64_t{0});
  }
}

// Each takes something from the start of `text`, or gives false.

bool take(std::string_view& text, char expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(1);
  return true;
}

template <class Number>
bool take_number(std::string_view& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

/// "7:waiting"
bool take_text(std::string_view& text, std::string& taken) {
  std::size_t size = 0;
  if (!take_number(text, size) || !take(text, ':') || size > text.size()) return false;
  taken = text.substr(0, size);
  text.remove_prefix(size);
  return true;
}

}  // namespace

void bind_report(Query& query, const dispatch::Report& report, const std::string& history) {
  const icd::Point& position = report.report.position;
  query.bind(report.number).bind(report.report.type).bind(position.x).bind(position.y).bind(position.z);
  query.bind(report.sender).bind(report.received).bind(report.changed);
  query.bind(dispatch::name_of(report.state)).bind(report.note);
  query.bind(report.run).bind(std::int64_t{report.asked}).bind(report.same_as);
  query.bind(report.tries).bind(report.sending).bind(report.sent);
  bind_status(query, report.before);
  query.bind(std::int64_t{report.status}).bind(report.content_type).bind_blob(report.answer);
  query.bind(std::int64_t{report.reconciled}).bind(history);
}

std::string history_of(std::span<const dispatch::Report> steps) {
  std::string history;
  for (const dispatch::Report& step : steps) {
    const std::string_view state = dispatch::name_of(step.state);
    history += icd::sentence(step.changed, " ", state.size(), ":", state, " ", step.note.size(), ":",
                             step.note, "\n");
  }
  return history;
}

std::optional<std::vector<Ledger::Step>> steps_of(std::int64_t number, std::string_view history) {
  std::vector<Ledger::Step> steps;
  while (!history.empty()) {
    Ledger::Step& step = steps.emplace_back();
    step.report = number;
    if (!take_number(history, step.at) || !take(history, ' ') || !take_text(history, step.state) ||
        !take(history, ' ') || !take_text(history, step.note) || !take(history, '\n')) {
      return std::nullopt;
    }
  }
  return steps;
}

dispatch::Report report_of(const Query& row) {
  Columns column(row);
  dispatch::Report report;
  report.number = column.number();
  report.report.type = column.bytes();
  report.report.position.x = column.real();
  report.report.position.y = column.real();
  report.report.position.z = column.real();
  report.sender = column.bytes();
  report.received = column.real();
  report.changed = column.real();
  const std::string state = column.bytes();
  const auto known = dispatch::state_named(state);
  report.state = known.value_or(dispatch::ReportState::InDoubt);
  report.note = column.bytes();
  report.run = column.number();
  report.asked = column.flag();
  report.same_as = column.number();
  report.tries = column.number();
  report.sending = column.number();
  report.sent = column.real();
  report.before = column.status();
  report.status = static_cast<int>(column.number());
  report.content_type = column.bytes();
  report.answer = column.bytes();
  report.reconciled = column.flag();
  if (!known) {  // only the operator can judge it: without `before` nobody else does
    report.note = "its state '" + state + "' is none that this version knows; " + report.note;
    report.before.reset();
  }
  return report;
}

void bind_run(Query& query, const dispatch::Run& run) {
  query.bind(run.number).bind(run.id).bind(run.began).bind(run.why);
  bind_status(query, run.last);
  query.bind(run.heard).bind(run.post).bind(run.unreliable);
}

void bind_sighting(Query& query, const dispatch::Run& run) {
  query.bind(run.number).bind(run.turn).bind(run.may_be);
  bind_clock(query, run.status_clock);
  bind_clock(query, run.answer_clock);
  query.bind(run.heard);
}

dispatch::Run run_of(const Query& row) {
  Columns column(row);
  dispatch::Run run;
  run.number = column.number();
  run.id = column.bytes();
  run.began = column.real();
  run.why = column.bytes();
  run.last = column.status();
  run.heard = column.real();
  run.post = column.bytes();
  run.unreliable = column.bytes();
  run.turn = column.number();
  run.may_be = column.number();
  run.status_clock = column.clock();
  run.answer_clock = column.clock();
  return run;
}

}  // namespace adit::ledger
