#include "cli/status_text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/board.hpp"
#include "api/reports_csv.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "dispatch/report.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::cli {
namespace {

using dispatch::ReportState;

std::string count_text(std::size_t count, const char* one, const char* several) {
  return count == 0 ? "" : std::to_string(count) + (count == 1 ? one : several);
}

std::string omitted_text(const OmittedReports& rest) {
  return count_text(rest.older, " older report is not listed\n", " older reports are not listed\n") +
         count_text(rest.of_other_runs, " report of another run is not listed: adit reports --run all\n",
                    " reports of other runs are not listed: adit reports --run all\n");
}

std::function<Cell(const facts::ReportRow&)> coordinate(double icd::Point::* axis) {
  return [axis](const facts::ReportRow& report) {
    return report.position ? decimal((*report.position).*axis, 2) : "lost";
  };
}

/// A state unknown to this adit is shown as in doubt.
ReportState state_of(const facts::ReportRow& report) {
  return dispatch::state_named(report.state).value_or(ReportState::InDoubt);
}

}  // namespace

bool needs_the_operator(const facts::ReportRow& report) {
  const ReportState state = state_of(report);
  return (state == ReportState::Held && !report.sends_at) ||
         (state == ReportState::InDoubt && !report.asking);
}

bool is_finished(const facts::ReportRow& report) {
  return dispatch::is_final(state_of(report));
}

std::vector<std::string_view> verbs_for(const facts::ReportRow& report) {
  using dispatch::ReportEvent;
  const auto state = dispatch::state_named(report.state);
  if (!state) return {};
  std::vector<std::string_view> verbs;
  const auto offer = [&verbs](bool possible, std::string_view verb) {
    if (possible) verbs.push_back(verb);
  };
  offer(dispatch::transition(*state, ReportEvent::Released) != nullptr, "send");
  offer(dispatch::transition(*state, ReportEvent::HeldBack) != nullptr || report.sends_at, "hold");
  offer(dispatch::transition(*state, ReportEvent::Withdrawn) != nullptr, "withdraw");
  offer(dispatch::transition(*state, ReportEvent::Corrected) != nullptr, "correct");
  offer(dispatch::transition(*state, ReportEvent::Settled) != nullptr, "settle");
  offer(dispatch::is_final(*state), "resubmit");
  return verbs;
}

std::string report_state(const facts::ReportRow& report) {
  const auto state = dispatch::state_named(report.state);
  if (!state) return report.state;
  std::string life(dispatch::display_name(*state));
  if (report.sends_at) life += ", to be sent";
  return report.asking && *state == ReportState::InDoubt ? life + ", asking" : life;
}

Tone tone_of(const facts::ReportRow& report) {
  if (needs_the_operator(report)) return Tone::Bad;
  switch (state_of(report)) {
    case ReportState::Rejected:
      return Tone::Bad;
    case ReportState::Answered:
      return Tone::Good;
    case ReportState::Settled:
      return report.reconciled ? Tone::Good : Tone::Plain;
    case ReportState::Withdrawn:
      return Tone::Plain;
    case ReportState::Held:
    case ReportState::Queued:
    case ReportState::Sending:
    case ReportState::InDoubt:
      break;
  }
  return Tone::Warning;
}

std::string outcome_text(const facts::ReportRow& report) {
  const bool is_error = report.status >= 300 && !report.reconciled;
  return icd::join_words(std::array{std::string(report.reconciled ? "found out" : ""),
                                    is_error ? "error " + std::to_string(report.status) : "",
                                    report.report_status});
}

std::string gain_text(const facts::ReportRow& report) {
  if (!report.score_change) return "";
  std::string text = *report.score_change > 0 ? "+" : "";
  return text.append(std::to_string(*report.score_change));
}

std::string reports_text(const std::vector<facts::ReportRow>& reports, const OmittedReports& rest,
                         api::Time now, bool colour) {
  if (reports.empty())
    return (rest.of_other_runs == 0 ? "No reports so far.\n" : "No reports in this run so far.\n") +
           omitted_text(rest);
  using Row = facts::ReportRow;
  const std::vector<ColumnOf<Row>> columns = {
      {"no.", [](const Row& row) { return std::to_string(row.number); }, kRight},
      {"run", [](const Row& row) { return std::to_string(row.run); }, kRight},
      {"type", [](const Row& row) { return Cell(row.type, Tone::Strong); }},
      {"x", coordinate(&icd::Point::x), kRight},
      {"y", coordinate(&icd::Point::y), kRight},
      {"z", coordinate(&icd::Point::z), kRight},
      {"state", [](const Row& row) { return Cell(report_state(row), tone_of(row)); }},
      {"score", gain_text, kRight},
      {"answer or reason",
       [](const Row& row) { return icd::join_words(std::array{outcome_text(row), row.note}); }},
      {"sender", &Row::sender},
      {"robot", &Row::robot},
      {"received", [now](const Row& row) { return duration(now - row.received) + " ago"; }, kRight}};
  return table_of(reports, columns, colour) + omitted_text(rest);
}

namespace {

using api::RunView;

/// "  ? Report 7 is in doubt (10 s): the status cannot tell": the sign is a shape in addition to the colour.
std::string alarm_line(const alarms::Alarm& alarm, api::Time now, bool colour) {
  constexpr struct {
    char sign;
    Tone tone;
  } kForms[] = {{'x', Tone::Bad}, {'?', Tone::Bad}, {'!', Tone::Warning}};
  const auto& form = kForms[static_cast<std::size_t>(alarm.severity)];
  const std::string what = icd::sentence(std::string_view(&form.sign, 1), " ", alarm.what);
  const std::string& why = alarm.details.empty() ? alarm.why : alarm.details;
  return "  " + paint(host::escape(what), alarm.acknowledged ? Tone::Faint : form.tone, colour) +
         icd::sentence(" (", duration(now - alarm.since), alarm.acknowledged ? ", acknowledged" : "",
                       alarm.hides > 0 ? ", hides " + std::to_string(alarm.hides) : "", ")",
                       why.empty() ? "" : ": " + host::escape(why), "\n");
}

std::string alarm_lines(const RunView& view, bool colour) {
  std::string text;
  for (const alarms::Alarm& alarm : view.alarms) text += alarm_line(alarm, view.now, colour);
  return text.empty() ? "" : text + '\n';
}

std::string verdict_line(const RunView& view, bool colour) {
  if (view.verdict.what.empty()) return "";
  return "Maps  " + paint(view.verdict.what, tone_of_level(view.verdict.level), colour) + ": " +
         host::escape(view.verdict.why) + '\n';
}

/// "12:34", "about 12:34"
std::string clock_text(const alarms::ShownClock& shown, double seconds) {
  return (shown.old && shown.runs ? "about " : "") + clock(seconds);
}

/// Remaining time of the run by the settings.
std::string remaining_text(const RunView& view, const alarms::ShownClock& shown) {
  const double left = static_cast<double>(view.run_seconds) - shown.seconds;
  return clock_text(shown, std::abs(left)) + (left < 0 ? " over time" : " to go");
}

std::string run_line(const RunView& view, bool colour) {
  if (!view.run || !view.run_clock)
    return paint("Run   no status from the Command Post yet", Tone::Warning, colour) + '\n';
  const icd::RunStatus& run = *view.run;
  const alarms::ShownClock& shown = *view.run_clock;
  const Tone tone = shown.old ? Tone::Faint : Tone::Strong;
  std::string text = "Run   " + paint(clock_text(shown, shown.seconds), tone, colour) + "   " +
                     remaining_text(view, shown) + "   score " +
                     paint(std::to_string(run.score), tone, colour) + "   " +
                     paint(std::to_string(run.remaining_reports), tone, colour) + " reports left";
  if (!run.current_team.empty()) text += "   team " + host::escape(run.current_team);
  text +=
      paint("   (heard " + duration(shown.age) + " ago)", shown.old ? Tone::Warning : Tone::Faint, colour);
  return text + '\n';
}

std::string link_line(const RunView& view) {
  return "Link  " + decimal(view.sent_mbit, 1) + " of " + decimal(view.budget_mbit, 1) + " Mbit/s   " +
         icd::size_text(view.queued_bytes) + " of maps queued\n";
}

std::string reports_line(const RunView& view, bool colour) {
  std::map<std::string, int> states;
  std::set<std::string> urgent;
  for (const facts::ReportRow& report : view.reports) {
    const std::string state = report_state(report);
    ++states[state];
    if (needs_the_operator(report)) urgent.insert(state);
  }
  std::string text = states.empty() ? "Reports  0" : "Reports";
  for (const auto& [state, number] : states) {
    const std::string words = std::to_string(number) + " " + host::escape(state);
    text += "  " + paint(words, urgent.contains(state) ? Tone::Bad : Tone::Plain, colour);
  }
  if (view.reports.size() >= RunView::kMostReports)
    text += icd::sentence(" (of the last ", RunView::kMostReports, ")");
  return text + '\n';
}

constexpr double kFreshFor = 10;  // seconds for which an answer is not called old

std::string last_answer(const facts::EndpointRow& endpoint) {
  if (endpoint.last_status == 0) return "";
  std::string text = "last answer: " + answer_of(endpoint.last_status, "");
  if (endpoint.answer_ms)
    text += " in " + decimal(*endpoint.answer_ms, *endpoint.answer_ms < 10 ? 1 : 0) + " ms";
  if (endpoint.answered.value_or(0) > kFreshFor) text += ", " + duration(*endpoint.answered) + " ago";
  return text;
}

std::string endpoints_table(const RunView& view, bool colour) {
  Table table({{}, {}, {}, {}, {}});
  for (const facts::EndpointRow& endpoint : view.endpoints) {
    table.add({{endpoint.name, Tone::Strong},
               {endpoint.address},
               {endpoint.word, tone_of_level(endpoint.level)},
               {last_answer(endpoint)},
               {endpoint.trouble, Tone::Bad}});
  }
  return table.empty() ? "" : "\nCommand Post\n" + table.to_text(colour);
}

/// The kind, the mode of clouds, and counts of messages that were left out or are invisible.
std::string kind_of(const facts::ActivityRow& row) {
  std::string kind = row.kind;
  if (!row.clouds.empty()) kind += ", " + row.clouds;
  if (!row.precision.empty() && row.precision != "exact") kind += ", to " + row.precision;
  if (row.no_valid_point > 0) kind += ", " + std::to_string(row.no_valid_point) + " without a valid point";
  if (row.invisible > 0) kind += ", " + std::to_string(row.invisible) + " invisible";
  return kind;
}

std::string activities_table(const RunView& view, bool colour) {
  using Row = facts::ActivityRow;
  const auto no_room = [](const Row& row) {
    return Cell(row.no_room == 0 ? "" : std::to_string(row.no_room), Tone::Warning);
  };
  const auto answer = [](const Row& row) {
    const Tone tone = row.level == facts::Level::Bad ? Tone::Bad : Tone::Plain;
    return Cell(answer_of(row.last_status, row.last_sentence), tone);
  };
  const std::vector<ColumnOf<Row>> columns = {
      {"robot", [](const Row& row) { return Cell(row.robot.empty() ? "(all)" : row.robot, Tone::Strong); }},
      {"kind", kind_of},
      {"arriving", [](const Row& row) { return Cell(row.word, tone_of_level(row.level)); }},
      {"accepted", [](const Row& row) { return std::to_string(row.accepted); }, kRight},
      {"sent", [](const Row& row) { return std::to_string(row.forwarded); }, kRight},
      {"queued", [](const Row& row) { return std::to_string(row.queued); }, kRight},
      {"no room", no_room, kRight},
      {"age", [](const Row& row) { return row.age ? duration(*row.age) : ""; }, kRight},
      {"heard", [](const Row& row) { return row.heard ? duration(*row.heard) + " ago" : "never"; }, kRight},
      // of the last sent map; the last accepted map may be another
      {"size", [](const Row& row) { return row.last_forwarded ? icd::size_text(row.bytes_sent) : ""; },
       kRight},
      {"last answer", answer}};
  return view.activities.empty()
             ? ""
             : "\nMaps, states and markers\n" + table_of(view.activities, columns, colour);
}

std::string refusals_table(const RunView& view, bool colour) {
  static constexpr std::size_t kShown = 5;
  Table table({{}, {}, {}, {}, {}});
  for (std::size_t i = 0; i < view.refusals.size() && i < kShown; ++i) {
    const facts::RefusalRow& refusal = view.refusals[i];
    table.add({{duration(view.now - refusal.at) + " ago", Tone::Faint},
               {refusal.sender},
               {refusal.uri},
               {std::to_string(refusal.status), Tone::Warning},
               {refusal.sentence}});
  }
  return table.empty() ? "" : "\nRejected from clients, newest first\n" + table.to_text(colour);
}

}  // namespace

Tone tone_of_level(facts::Level level) {
  constexpr Tone kTones[] = {Tone::Faint, Tone::Good, Tone::Warning, Tone::Bad};
  return kTones[static_cast<std::size_t>(level)];
}

std::string status_text(const RunView& view, bool colour) {
  return alarm_lines(view, colour) + run_line(view, colour) + verdict_line(view, colour) + link_line(view) +
         reports_line(view, colour) + endpoints_table(view, colour) + activities_table(view, colour) +
         refusals_table(view, colour);
}

Result<Outcome> status(const Call& call) {
  const auto run = ADIT_TRY(fetch<RunView>(call.adit, "/adit/run"));
  const auto update = fetch<api::UpdateView>(call.adit, "/adit/update");
  const bool is_fine = std::ranges::none_of(run.row.alarms, alarms::calls);
  return print_result(
      call, run.json,
      status_text(run.row, call.console.colour) +
          (update ? newer_lines(update->row)
                  : line("cannot ask for newer versions: ", update.error().sentence)) +
          (run.row.certificate.empty() ? ""
                                       : line("HTTPS: SHA-256 of the certificate is ", run.row.certificate)),
      is_fine ? Exit::Fine : Exit::Attention);
}

namespace {

/// Lines that begin with the time.
class Lines {
 public:
  Lines(api::Time at, bool colour) : at_(at), colour_(colour) {}
  void add(const std::string& what, Tone tone = Tone::Plain) {
    text_ += paint(api::iso_time(at_), Tone::Faint, colour_) + "  " +
             paint(host::escape(what), tone, colour_) + '\n';
  }
  const std::string& text() const { return text_; }

 private:
  api::Time at_;
  bool colour_;
  std::string text_;
};

void add_alarm_lines(const api::RunView& before, const api::RunView& now, Lines& lines) {
  const auto is_in = [](const api::RunView& view, const alarms::Alarm& alarm) {
    return std::ranges::count(view.alarms, alarm.id, &alarms::Alarm::id) > 0;
  };
  for (const alarms::Alarm& alarm : now.alarms) {
    if (!is_in(before, alarm))
      lines.add("ALARM  " + alarms::line_of(alarm), alarms::calls(alarm) ? Tone::Bad : Tone::Warning);
  }
  for (const alarms::Alarm& alarm : before.alarms) {
    if (!is_in(now, alarm)) lines.add("alarm over: " + alarms::line_of(alarm), Tone::Good);
  }
}

/// The run without its clock, which always changes.
std::string run_text(const api::RunView& view) {
  if (!view.run) return "no status from the Command Post yet";
  const icd::RunStatus& run = *view.run;
  return icd::sentence("score ", run.score, ", ", run.remaining_reports, " reports left",
                       run.current_team.empty() ? "" : ", team ", run.current_team);
}

void run(const api::RunView& before, const api::RunView& now, Lines& lines) {
  if (now.run_number != before.run_number) lines.add(icd::sentence("run ", now.run_number, " begins"));
  const std::string told = run_text(now);
  if (told != run_text(before))
    lines.add(now.run ? icd::sentence("run ", clock(now.run->run_clock), ": ", told) : "run: " + told);
}

/// Older reports are listed once others have left the list. That is no change.
bool was_left_out(const facts::ReportRow& report, const api::RunView& before) {
  return before.reports.size() >= api::RunView::kMostReports &&
         report.number < before.reports.front().number && report.changed < before.now;
}

void add_report_lines(const api::RunView& before, const api::RunView& now, Lines& lines) {
  for (const facts::ReportRow& report : now.reports) {
    const auto was = std::ranges::find(before.reports, report.number, &facts::ReportRow::number);
    const bool is_listed = was != before.reports.end();
    const std::string life = report_state(report);
    if (is_listed ? report_state(*was) == life : was_left_out(report, before)) continue;
    const std::string why = report.note.empty() ? "" : " (" + report.note + ")";
    const std::string score = gain_text(report).empty() ? "" : ", score " + gain_text(report);
    lines.add(icd::sentence("report ", report.number, " ", report.type, ": ", life, score, why),
              tone_of(report));
  }
}

std::string state_of(const facts::EndpointRow& endpoint) {
  return endpoint.trouble.empty() ? endpoint.word : endpoint.word + ", " + endpoint.trouble;
}

void add_endpoint_lines(const api::RunView& before, const api::RunView& now, Lines& lines) {
  for (const facts::EndpointRow& endpoint : now.endpoints) {
    const auto was = std::ranges::find(before.endpoints, endpoint.name, &facts::EndpointRow::name);
    if (was != before.endpoints.end() && state_of(*was) == state_of(endpoint)) continue;
    lines.add(endpoint.name + " endpoint: " + state_of(endpoint), tone_of_level(endpoint.level));
  }
}

constexpr std::string_view kArrives = "arrives", kNotArriving = "NOT ARRIVING";

/// In the order of facts::Arrival. Late shows as arriving, because robots that share the link take turns.
constexpr std::string_view kTold[] = {"none sent yet", kArrives,     kArrives,     kArrives, kNotArriving,
                                      kNotArriving,    kNotArriving, kNotArriving, kArrives, "silent"};
static_assert(std::size(kTold) == std::size(facts::kArrivalWords));

std::string_view arrival_text(const facts::ActivityRow& row) {
  return kTold[static_cast<std::size_t>(row.arrival)];
}

void add_arrival_lines(const api::RunView& before, const api::RunView& now, Lines& lines) {
  for (const facts::ActivityRow& row : now.activities) {
    const auto was = std::ranges::find_if(before.activities, [&row](const facts::ActivityRow& each) {
      return each.robot == row.robot && each.kind == row.kind;
    });
    const std::string_view told = arrival_text(row);
    if (was != before.activities.end() && arrival_text(*was) == told) continue;
    const std::string why = told == kNotArriving ? ": " + row.last_sentence : "";
    lines.add(icd::sentence(row.robot.empty() ? "all robots" : row.robot, ", ", row.kind, ": ", told, why),
              tone_of_level(row.level));
  }
}

/// The end of the colour sequence (ECMA-48, CSI ... m) at `at`, or `at` if there is none.
std::size_t colour_end(std::string_view line, std::size_t at) {
  if (!line.substr(at).starts_with("\033[")) return at;
  const std::size_t end = line.find('m', at);
  return end == std::string_view::npos ? line.size() : end + 1;
}

std::string cut(std::string_view line, std::size_t columns) {
  std::string text;
  std::size_t shown = 0;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = colour_end(line, at);
    if (end == at) {
      if (++shown > columns) return text + "\033[0m";
      do ++end;
      while (end < line.size() && !icd::begins_character(line[end]));
    }
    text += line.substr(at, end - at);
    at = end;
  }
  return text;
}

}  // namespace

std::string changes_text(const api::RunView& before, const api::RunView& now, bool colour) {
  Lines lines(now.now, colour);
  add_alarm_lines(before, now, lines);
  run(before, now, lines);
  add_endpoint_lines(before, now, lines);
  add_report_lines(before, now, lines);
  add_arrival_lines(before, now, lines);
  return lines.text();
}

std::string fit(std::string_view text, std::size_t rows, std::size_t columns) {
  std::vector<std::string_view> lines;
  while (!text.empty()) lines.push_back(icd::cut(text, '\n'));
  const bool all = lines.size() <= rows;
  const std::size_t whole = all ? lines.size() : rows - std::min<std::size_t>(rows, 1);
  std::string shown;
  for (std::size_t i = 0; i < whole; ++i) shown.append(i == 0 ? "" : "\n").append(cut(lines[i], columns));
  if (!all && rows > 0)
    shown.append(whole == 0 ? "" : "\n")
        .append(cut(icd::sentence("... ", lines.size() - whole, " more lines"), columns));
  return shown;
}

}  // namespace adit::cli
