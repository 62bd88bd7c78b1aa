#include "ledger/rows.hpp"

#include <algorithm>
#include <charconv>

#include "icd/sentence.hpp"

namespace adit::ledger {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using dispatch::Run;

/// The words of the tables, in the order of the states. Other words than the API's: a ledger outlives
/// versions.
constexpr std::string_view kStored[] = {"received", "waiting",  "sending", "answered",
                                        "refused",  "in doubt", "settled", "withdrawn"};

std::string_view stored_word(ReportState state) {
  return kStored[static_cast<std::size_t>(state)];
}

std::optional<ReportState> state_stored_as(std::string_view word) {
  const auto* const at = std::ranges::find(kStored, word);
  if (at == std::end(kStored)) return std::nullopt;
  return static_cast<ReportState>(at - std::begin(kStored));
}

/// The columns of a row that is read, one after the other.
class Columns {
 public:
  explicit Columns(const Query& row) : row_(row) {}

  void take(std::int64_t& number) { number = row_.number(next_++); }
  void take(int& number) { number = static_cast<int>(row_.number(next_++)); }
  void take(bool& flag) { flag = row_.number(next_++) != 0; }
  void take(double& real) { real = row_.real(next_++); }
  void take(std::string& bytes) { bytes = row_.bytes(next_++); }
  void take(dispatch::ReportState& state) {
    unknown_ = row_.bytes(next_++);
    const auto known = state_stored_as(unknown_);
    state = known.value_or(dispatch::ReportState::InDoubt);
    if (known) unknown_.clear();
  }
  void take(std::optional<dispatch::Clock>& clock) {
    const bool none = row_.is_null(next_);
    dispatch::Clock taken;
    take(taken.shows);
    take(taken.runs);
    if (!none) clock = taken;
  }
  void take(std::optional<icd::RunStatus>& status) {
    const bool none = row_.is_null(next_);
    icd::RunStatus taken;
    take(taken.score);
    take(taken.run_clock);
    take(taken.remaining_reports);
    take(taken.current_team);
    if (!none) status = std::move(taken);
  }

  /// The word of a state that this version does not know, or "".
  const std::string& unknown_state() const { return unknown_; }

 private:
  const Query& row_;
  int next_ = 0;
  std::string unknown_;
};

void put(Query& query, std::integral auto number) {
  query.bind(std::int64_t{number});
}
void put(Query& query, double real) {
  query.bind(real);
}
void put(Query& query, const std::string& text) {
  query.bind(text);
}
void put(Query& query, dispatch::ReportState state) {
  query.bind(stored_word(state));
}
void put(Query& query, const std::optional<dispatch::Clock>& clock) {
  clock ? query.bind(clock->shows) : query.bind_null();
  query.bind(std::int64_t{clock && clock->runs});
}
void put(Query& query, const std::optional<icd::RunStatus>& status) {
  if (!status) {
    query.bind_null().bind_null().bind_null().bind_null();
    return;
  }
  query.bind(status->score).bind(status->run_clock).bind(status->remaining_reports);
  query.bind(status->current_team);
}

/// What stands behind the name of a member that takes several columns.
constexpr std::string_view kOne[] = {""}, kOfClock[] = {"", "_runs"},
                           kOfStatus[] = {"score", "run_clock", "remaining_reports", "current_team"};

template <class T>
constexpr std::span<const std::string_view> kParts = kOne;
template <>
constexpr std::span<const std::string_view> kParts<std::optional<dispatch::Clock>> = kOfClock;
template <>
constexpr std::span<const std::string_view> kParts<std::optional<icd::RunStatus>> = kOfStatus;

/// What an update does with a column of a row that is there: it names the row, must be as it was, or is new.
enum class On : std::uint8_t { Key, Fixed, New };

/// A member of a row and its column, or columns.
template <class Row>
struct Column {
  std::string_view name;
  std::span<const std::string_view> parts;
  void (*bind)(Query& query, const Row& row);
  void (*read)(Columns& from, Row& row);
  On update = On::New;

  constexpr Column on(On does) const { return {name, parts, bind, read, does}; }
};

/// The member at the end of a way of pointers to members.
template <auto first, auto... rest>
constexpr auto column(std::string_view name) {
  return [=]<class Row, class T>(T Row::* /*first*/) {
    using Last = std::remove_cvref_t<decltype(((std::declval<Row&>().*first).*....*rest))>;
    return Column<Row>{name, kParts<Last>,
                       [](Query& query, const Row& row) { put(query, ((row.*first).*....*rest)); },
                       [](Columns& from, Row& row) { from.take(((row.*first).*....*rest)); }};
  }(first);
}

using icd::ArtifactReport;
using icd::Point;

// The members in the order of their columns: that of the bindings, of the readings, and in a proof.

constexpr Column<Report> kReport[] = {
    column<&Report::number>("number").on(On::Key),
    column<&Report::report, &ArtifactReport::type>("type").on(On::Fixed),
    column<&Report::report, &ArtifactReport::position, &Point::x>("x").on(On::Fixed),
    column<&Report::report, &ArtifactReport::position, &Point::y>("y").on(On::Fixed),
    column<&Report::report, &ArtifactReport::position, &Point::z>("z").on(On::Fixed),
    column<&Report::sender>("sender"),
    column<&Report::received>("received").on(On::Fixed),
    column<&Report::changed>("changed"),
    column<&Report::state>("state"),
    column<&Report::note>("note"),
    column<&Report::run>("run"),
    column<&Report::asked>("asked"),
    column<&Report::same_as>("same_as"),
    column<&Report::tries>("tries"),
    column<&Report::sending>("sending"),
    column<&Report::sent>("sent"),
    column<&Report::before>("before_"),
    column<&Report::status>("status"),
    column<&Report::content_type>("content_type"),
    {"answer", kOne, [](Query& query, const Report& report) { query.bind_blob(report.answer); },
     [](Columns& from, Report& report) { from.take(report.answer); }},
    column<&Report::reconciled>("reconciled"),
};

constexpr Column<Run> kRun[] = {
    column<&Run::number>("number").on(On::Key),
    column<&Run::id>("id"),
    column<&Run::began>("began"),
    column<&Run::why>("why"),
    column<&Run::last>(""),
    column<&Run::heard>("heard"),
    column<&Run::post>("post"),
    column<&Run::unreliable>("unreliable"),
};

constexpr Column<Run> kSighting[] = {
    column<&Run::number>("number").on(On::Key),
    column<&Run::turn>("turn"),
    column<&Run::may_be>("may_be"),
    column<&Run::status_clock>("status_clock"),
    column<&Run::answer_clock>("answer_clock"),
    column<&Run::heard>("heard"),
};

using Names = std::vector<std::string>;

template <class Row, std::size_t count>
Names names_of(const Column<Row> (&columns)[count],
               std::initializer_list<On> of = {On::Key, On::Fixed, On::New}) {
  Names names;
  for (const Column<Row>& column : columns) {
    if (std::ranges::find(of, column.update) == of.end()) continue;
    for (const std::string_view part : column.parts) names.push_back(std::string(column.name).append(part));
  }
  return names;
}

Names with(Names names, std::string_view more) {
  names.emplace_back(more);
  return names;
}

/// "a, b": `each` makes a piece of a name and its place, from 1.
std::string list(const Names& names, const auto& each, std::string_view between = ", ") {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text.append(i == 0 ? "" : between).append(each(names[i], i + 1));
  return text;
}
std::string list(const Names& names) {
  return list(names, [](const std::string& name, std::size_t) { return name; });
}
/// "run.number, run.id"
std::string list_of(std::string_view table, const Names& names) {
  return list(names, [=](const std::string& name, std::size_t) { return icd::sentence(table, ".", name); });
}
/// "?1, ?2"
std::string places(const Names& names) {
  return list(names, [](const std::string&, std::size_t place) { return icd::sentence("?", place); });
}
/// "a = excluded.a"
std::string excluded(const Names& names, std::string_view between) {
  return list(
      names, [](const std::string& name, std::size_t) { return icd::sentence(name, " = excluded.", name); },
      between);
}

/// "number, a, proof) VALUES(?1, ?2, proof(?1, ?2))": of an INSERT.
std::string values(const Names& names) {
  return icd::sentence(list(names), ", proof) VALUES(", places(names), ", proof(", places(names), "))");
}

const Names kReportNames = names_of(kReport), kKept = with(kReportNames, "history"),
            kRunNames = names_of(kRun), kSightingNames = names_of(kSighting), kRobotNames{"number", "name"};

std::string prove(std::string_view table, const Names& names) {
  return icd::sentence("UPDATE ", table, " SET proof = proof(", list(names), ") WHERE proof = 1;");
}

std::string unproven(std::string_view what, std::string_view table, const Names& names) {
  return icd::sentence("SELECT '", what, "' || number FROM ", table, " WHERE proof NOT IN (1, proof(",
                       list(names), ")) UNION ALL ");
}

template <class Row, std::size_t count>
void bind_row(Query& query, const Column<Row> (&columns)[count], const Row& row) {
  for (const Column<Row>& column : columns) column.bind(query, row);
}

template <class Row, std::size_t count>
void read_row(Columns& from, const Column<Row> (&columns)[count], Row& row) {
  for (const Column<Row>& column : columns) column.read(from, row);
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

const std::string kWriteReport =
    icd::sentence("INSERT INTO report(", values(kKept), " ON CONFLICT(number) DO UPDATE SET ",
                  excluded(names_of(kReport, {On::New}), ", "),
                  ", history = history || excluded.history, proof = proof(", places(kReportNames),
                  ", history || excluded.history) WHERE ", excluded(names_of(kReport, {On::Fixed}), " AND "));

const std::string kWriteRobot =
    icd::sentence("INSERT INTO robot(", values(kRobotNames), " ON CONFLICT(number) DO NOTHING");

const std::string kReadReports =
    icd::sentence("SELECT ", list_of("report", kReportNames),
                  ", robot.name FROM report LEFT JOIN robot USING(number) ORDER BY report.number");

const std::string kReadHistory = "SELECT history FROM report WHERE number = ?";

const std::string kWriteRun =
    icd::sentence("INSERT INTO run(", values(kRunNames), " ON CONFLICT(number) DO UPDATE SET ",
                  excluded(with(names_of(kRun, {On::New}), "proof"), ", "));

const std::string kWriteSighting = icd::sentence("REPLACE INTO sighting(", values(kSightingNames));

// A run that nothing was seen of has NULL in each column of its sighting: its own number and time come after.
const std::string kReadRuns =
    icd::sentence("SELECT ", list_of("sighting", kSightingNames), ", ", list_of("run", kRunNames),
                  " FROM run LEFT JOIN sighting USING(number) ORDER BY run.number");

const std::string kProveRows = prove("report", kKept) + prove("run", kRunNames) +
                               prove("sighting", kSightingNames) + prove("robot", kRobotNames);

const std::string kUnprovenRow =
    icd::sentence(unproven("report ", "report", kKept), unproven("run ", "run", kRunNames),
                  unproven("the status of run ", "sighting", kSightingNames),
                  unproven("the robot of report ", "robot", kRobotNames), R"(
  SELECT 'the mark' FROM mark WHERE proof != proof(number, log_needed, log_size, highest)
  UNION ALL SELECT 'report ' || highest FROM mark
    WHERE highest > (SELECT coalesce(max(number), 0) FROM report)
  UNION ALL SELECT '' LIMIT 1)");

void bind_report(Query& query, const Report& report, const std::string& history) {
  bind_row(query, kReport, report);
  query.bind(history);
}

void bind_robot(Query& query, std::int64_t number, const icd::RobotName& robot) {
  query.bind(number).bind(robot.text());
}

std::string history_of(std::span<const dispatch::Report> steps) {
  std::string history;
  for (const dispatch::Report& step : steps) {
    const std::string_view state = stored_word(step.state);
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
    if (const auto state = state_stored_as(step.state)) step.state = dispatch::name_of(*state);
  }
  return steps;
}

Report report_of(const Query& row) {
  Columns from(row);
  Report report;
  read_row(from, kReport, report);
  std::string robot;  // NULL reads as ""
  from.take(robot);
  report.report.robot = icd::RobotName::parse(robot);
  if (!from.unknown_state().empty()) {  // only the operator can judge it: without `before` nobody else does
    report.note = "its state '" + from.unknown_state() + "' is unknown to this version; " + report.note;
    report.before.reset();
  }
  return report;
}

void bind_run(Query& query, const Run& run) {
  bind_row(query, kRun, run);
}

void bind_sighting(Query& query, const Run& run) {
  bind_row(query, kSighting, run);
}

Run run_of(const Query& row) {
  Columns from(row);
  Run run;
  read_row(from, kSighting, run);
  read_row(from, kRun, run);
  return run;
}

}  // namespace adit::ledger
