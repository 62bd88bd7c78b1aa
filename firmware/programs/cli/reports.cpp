#include <algorithm>
#include <map>
#include <span>

#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "cli/ask.hpp"
#include "cli/handlers.hpp"
#include "cli/status_text.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "command_line/program.hpp"
#include "dispatch/report.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "ledger/dump.hpp"

namespace adit::cli {

Result<Outcome> dump_ledger(const Options& options, const Console& console) {
  const auto damage =
      ledger::dump(options.argument().empty() ? "/var/lib/adit/ledger" : options.argument(), console.print);
  if (!damage) return to_failure(damage.error().what);
  Outcome outcome;
  if (!damage->empty()) outcome.exit = Exit::Attention;
  for (const std::string& each : *damage) outcome.err += "adit: " + host::escape(each) + '\n';
  return outcome;
}

Result<Outcome> begin_ledger(const Call& call) {
  ADIT_TRY(confirm(call.options, call.console,
                   "The files of the ledger that cannot be read will be kept, but Adit will not "
                   "know their reports: a report may be sent twice.",
                   "Begin another ledger?"));
  return act(call, {.target = "/adit/ledger/new", .check = "adit status"},
             "aditd restarts with another ledger: see adit status\n");
}

namespace {

/// Default: reports of the present run, and unfinished ones of other runs.
bool is_listed(const facts::ReportRow& report, const Options& options, std::int64_t present) {
  if (options.all_runs) return true;
  return options.run ? report.run == *options.run : report.run == present || !is_finished(report);
}

}  // namespace

Result<Outcome> list_reports(const Call& call) {
  const Options& options = call.options;
  const auto run = ADIT_TRY(fetch<api::RunView>(call.adit, "/adit/run"));
  auto told = ADIT_TRY(fetch<std::vector<facts::ReportRow>>(call.adit, "/adit/reports"));

  std::vector<facts::ReportRow>& rows = told.row;
  const Exit exit = std::ranges::any_of(rows, needs_the_operator) ? Exit::Attention : Exit::Fine;
  const std::size_t others = std::erase_if(
      rows, [&](const facts::ReportRow& row) { return !is_listed(row, options, run.row.run_number); });
  std::ranges::reverse(rows);  // newest first
  const auto all = static_cast<std::int64_t>(rows.size()), shown = std::min(all, options.last.value_or(all));
  rows.resize(static_cast<std::size_t>(shown));
  const OmittedReports rest{.older = static_cast<std::size_t>(all - shown), .of_other_runs = others};
  return print_result(call, codec::to_json(rows), reports_text(rows, rest, run.row.now, call.console.colour),
                      exit);
}

Result<Outcome> show_report(const Call& call) {
  return show<api::ReportDetail>(
      call, "/adit/reports/" + std::to_string(call.options.numbers.front()), report_text,
      [](const api::ReportDetail& detail) { return !needs_the_operator(detail.row); });
}

Result<Outcome> export_reports(const Call& call) {
  const bool json = call.options.json;
  const auto text = ADIT_TRY(get(call.adit, json ? "/adit/reports" : "/adit/reports.csv"));
  return print_result(call, text, text);
}

namespace {

std::string place_of(const icd::Point& point) {
  return decimal(point.x, 3) + ", " + decimal(point.y, 3) + ", " + decimal(point.z, 3) + " m";
}

std::string facts_of(const api::ReportDetail& detail, bool colour) {
  const facts::ReportRow& report = detail.row;
  Facts facts;
  facts.add("report", std::to_string(report.number), Tone::Strong);
  facts.add("type", report.type, Tone::Strong);
  facts.add("at", report.position ? place_of(*report.position) : "lost");
  facts.add("state", report_state(report), tone_of(report));
  facts.add("reason", report.note);
  facts.add("answer", outcome_text(report));
  facts.add("score", gain_text(report));
  facts.add("run", std::to_string(report.run));
  facts.add("sender", report.sender);
  facts.add("robot", report.robot);
  facts.add("received", api::iso_time(report.received));
  facts.add("message", sentence_in(detail.answer));
  facts.add("actions", icd::join_words(verbs_for(report)));
  return facts.to_text(colour);
}

std::string state_text(const std::string& state) {
  const auto known = dispatch::state_named(state);
  return known ? std::string(dispatch::display_name(*known)) : state;
}

std::string history(const api::ReportDetail& detail, bool colour) {
  Table table({{}, {}, {}});
  for (const api::ReportStep& step : detail.history) {
    table.add({{api::iso_time(step.at), Tone::Faint}, {state_text(step.state), Tone::Strong}, {step.note}});
  }
  return table.empty() ? "" : "\nHistory\n" + table.to_text(colour);
}

}  // namespace

std::string report_text(const api::ReportDetail& detail, bool colour) {
  return facts_of(detail, colour) + history(detail, colour);
}

namespace {

/// Adit's answer to a decision. `report`: number of the new report, if any.
struct DecidedReport {
  std::int64_t report = 0;
  static const codec::Row kRow;
};
constexpr codec::Member kDecided[] = {codec::member<&DecidedReport::report>("report")};

struct BegunRun {
  std::int64_t run = 0;
  static const codec::Row kRow;
};
constexpr codec::Member kBegun[] = {codec::member<&BegunRun::run>("run")};

/// The end of the sentence "report 5 is queued", by subcommand.
struct Decision {
  std::string_view verb;
  const char* done;
};
constexpr Decision kDecisions[] = {{"send", " is queued"},
                                   {"hold", " is held until you send it"},
                                   {"withdraw", " is withdrawn"},
                                   {"settle", " is settled"},
                                   {"resubmit", " is sent again as report "}};

struct Axis {
  const char* name;
  double icd::Point::* axis;
};
constexpr Axis kAxes[] = {{"x", &icd::Point::x}, {"y", &icd::Point::y}, {"z", &icd::Point::z}};

constexpr double kFar = 1e9;  // metres
constexpr std::uint64_t kMostNumber = INT64_MAX;

using ReportFields = std::map<std::string, codec::Value>;

/// Reads type=TYPE, x=X, y=Y and z=Z.
Result<void> read_fields(std::span<const std::string> words, ReportFields& fields) {
  for (const std::string& word : words) {
    const std::size_t end = word.find('=');
    const std::string name = word.substr(0, end),
                      value = end == std::string::npos ? "" : word.substr(end + 1);
    const bool is_axis = std::ranges::find(kAxes, name, &Axis::name) != std::end(kAxes);
    if (end == std::string::npos || (name != "type" && !is_axis))
      return to_failure("'" + word + "': expected type=, x=, y= or z=");
    double metres = 0;
    if (const auto wrong = is_axis ? command_line::read_number(value, -kFar, kFar, metres) : std::nullopt)
      return to_failure(name + ": " + *wrong);
    fields[name] = is_axis ? codec::Value{metres} : codec::Value{value};
  }
  return {};
}

/// Asks the operator for confirmation if the report is in doubt.
Result<void> confirm_sending(const Call& call, const std::string& target, std::int64_t number) {
  const facts::ReportRow report = ADIT_TRY(fetch<api::ReportDetail>(call.adit, target)).row.row;
  if (dispatch::state_named(report.state) != dispatch::ReportState::InDoubt) return {};
  return confirm(call.options, call.console,
                 icd::sentence("report ", number, " (", report.type,
                               ") is in doubt: if the Command Post recorded it, sending it again uses up a "
                               "second report.",
                               report.asking ? " Adit is asking the run's status to find out." : ""),
                 "Send it again?", icd::sentence("report ", number, " was not sent"));
}

Result<Outcome> decide_on(const Call& call, std::int64_t number) {
  const std::string verb = call.options.word(), target = icd::sentence("/adit/reports/", number);
  if (verb == "send" && !call.options.yes) {
    ADIT_TRY(confirm_sending(call, target, number));
  }
  const bool is_new = verb == "resubmit";
  const std::string check = is_new ? "adit reports" : icd::sentence("adit reports show ", number);
  const auto answer = ADIT_TRY(read_row_of<DecidedReport>(
      call.adit, post(call.adit, {.target = target + "/" + verb, .check = check})));
  const char* const done = std::ranges::find(kDecisions, verb, &Decision::verb)->done;
  const std::string moved = is_new ? std::to_string(answer.row.report) : "";
  return print_result(call, answer.json, icd::sentence("report ", number, done, moved, "\n"));
}

}  // namespace

constexpr codec::Row DecidedReport::kRow = codec::complete<DecidedReport>({"", kDecided});
constexpr codec::Row BegunRun::kRow = codec::complete<BegunRun>({"", kBegun});

Result<Outcome> decide_on_reports(const Call& call) {
  return act_on_each(call, [&call](std::int64_t number) { return decide_on(call, number); });
}

Result<Outcome> correct_report(const Call& call) {
  const std::vector<std::string>& words = call.options.arguments;
  std::uint64_t number = 0;
  if (const auto wrong = command_line::read_number(words.front(), std::uint64_t{1}, kMostNumber, number))
    return to_failure("the report's number: " + *wrong);
  const std::string target = icd::sentence("/adit/reports/", number);
  const auto now = ADIT_TRY(fetch<api::ReportDetail>(call.adit, target));
  const facts::ReportRow& report = now.row.row;
  ReportFields body{{"type", {report.type}}};
  for (const auto& [name, axis] : kAxes) {
    if (report.position) body[name] = {(*report.position).*axis};
  }
  ADIT_TRY(read_fields(std::span(words).subspan(1), body));
  const auto answer = ADIT_TRY(read_row_of<DecidedReport>(
      call.adit,
      post(call.adit, {.target = target + "/correct",
                       .check = icd::sentence("adit reports show ", number),
                       .body = codec::write_json({codec::Value::Object(body.begin(), body.end())})})));
  return print_result(call, answer.json,
                      icd::sentence("report ", number, " is corrected as report ", answer.row.report, "\n"));
}

Result<Outcome> compose_report(const Call& call) {
  ReportFields body;
  ADIT_TRY(read_fields(call.options.arguments, body));
  for (const char* const name : {"type", "x", "y", "z"}) {
    if (!body.contains(name)) return to_failure(std::string(name) + "= is missing");
  }
  const auto answer = ADIT_TRY(read_row_of<DecidedReport>(
      call.adit,
      post(call.adit, {.target = "/adit/reports",
                       .check = "adit reports",
                       .body = codec::write_json({codec::Value::Object(body.begin(), body.end())})})));
  return print_result(call, answer.json,
                      icd::sentence("report ", answer.row.report, " is accepted: see adit reports show ",
                                    answer.row.report, "\n"));
}

namespace {

/// What a new run would change: it cannot be undone.
std::string meaning_of_new_run(const api::RunView& view, const std::vector<facts::ReportRow>& reports) {
  using enum dispatch::ReportState;
  std::size_t recorded = 0, unsent = 0;
  for (const facts::ReportRow& report : reports) {
    const auto state = dispatch::state_named(report.state);
    if (state == Answered || state == Settled) ++recorded;
    if (state == Queued || state == Held) ++unsent;
  }
  const std::string still =
      view.run ? icd::sentence("The Command Post still shows this run",
                               view.run_id.empty() ? "" : " (" + view.run_id + ")", ": run clock ",
                               clock(view.run->run_clock), ", score ", view.run->score, ". ")
               : "";
  return icd::sentence(still, "Adit notices most new runs by itself. This ends run ", view.run_number,
                       " for good: ", recorded, recorded == 1 ? " report is" : " reports are",
                       " recorded in it, and repeats of ", recorded == 1 ? "it" : "them",
                       " would be sent again; ", unsent, unsent == 1 ? " unsent report" : " unsent reports",
                       " would be held.");
}

Result<void> confirm_new_run(const Call& call) {
  if (call.options.yes) return {};
  const auto view = ADIT_TRY(fetch<api::RunView>(call.adit, "/adit/run")).row;
  const auto reports = ADIT_TRY(fetch<std::vector<facts::ReportRow>>(
                                    call.adit, icd::sentence("/adit/reports?run=", view.run_number)))
                           .row;
  return confirm(call.options, call.console, meaning_of_new_run(view, reports), "Begin a new run?",
                 "no run was begun");
}

}  // namespace

Result<Outcome> begin_run(const Call& call) {
  ADIT_TRY(confirm_new_run(call));
  const auto answer = ADIT_TRY(
      read_row_of<BegunRun>(call.adit, post(call.adit, {.target = "/adit/runs", .check = "adit reports"})));
  return print_result(call, answer.json,
                      icd::sentence("run ", answer.row.run,
                                    " begins; unsent reports of earlier runs are held: see adit reports\n"));
}

Result<Outcome> identify(const Call& call) {
  const std::int64_t seconds = call.options.numbers.empty() ? 10 : call.options.numbers.front();
  return act(call,
             {.target = "/adit/identify",
              .check = "adit status",
              .body = icd::sentence("{\"seconds\":", seconds, "}")},
             icd::sentence("all lights flash for ", seconds, " s\n"));
}

namespace {

std::string rejected_text(const api::RunView& view, bool colour) {
  if (view.rejected.empty()) return "0 rejected messages\n";
  using Row = facts::RejectedRow;
  const auto answer = [](const Row& row) {
    return Cell(answer_of(row.status, row.why), row.replaced ? Tone::Faint : Tone::Bad);
  };
  const std::vector<ColumnOf<Row>> columns = {
      {"number", [](const Row& row) { return Cell(std::to_string(row.number), Tone::Strong); }, kRight},
      {"kind", &Row::kind},
      {"robot", [](const Row& row) { return row.robot.empty() ? "(all)" : row.robot; }},
      {"rejected", [&view](const Row& row) { return duration(view.now - row.at) + " ago"; }, kRight},
      {"size", [](const Row& row) { return icd::size_text(row.bytes); }, kRight},
      {"answer", answer},
      {"", [](const Row& row) { return Cell(row.replaced ? "replaced by a newer one" : "", Tone::Faint); }}};
  return table_of(view.rejected, columns, colour);
}

}  // namespace

Result<Outcome> list_rejected(const Call& call) {
  const api::RunView view = ADIT_TRY(fetch<api::RunView>(call.adit, "/adit/run")).row;
  const bool waits =
      std::ranges::any_of(view.rejected, [](const facts::RejectedRow& row) { return !row.replaced; });
  return print_result(call, codec::to_json(view.rejected), rejected_text(view, call.console.colour),
                      waits ? Exit::Attention : Exit::Fine);
}

Result<Outcome> decide_on_rejected(const Call& call) {
  const std::string verb = call.options.word();
  return act_on_each(call, [&](std::int64_t number) {
    return act(call,
               {.target = icd::sentence("/adit/rejected/", number, "/", verb), .check = "adit rejected"},
               icd::sentence("message ", number, verb == "send" ? " is queued again\n" : " is deleted\n"));
  });
}

}  // namespace adit::cli
