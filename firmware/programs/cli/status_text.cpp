#include "cli/status_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "alarms/board.hpp"
#include "cli/handlers.hpp"
#include "cli/reports_text.hpp"
#include "cli/table.hpp"
#include "cli/words.hpp"
#include "host/log.hpp"

namespace adit::cli {
namespace {

using api::RunView;
using Align = Table::Align;

/// A shape and a word in addition to the colour.
Cell severity_cell(const alarms::Alarm& alarm) {
  constexpr struct {
    const char* word;
    Tone tone;
  } kForms[] = {{"x bad", Tone::Bad}, {"? ask", Tone::Bad}, {"! wait", Tone::Warning}};
  const auto& form = kForms[static_cast<std::size_t>(alarm.severity)];
  return {form.word, alarm.acknowledged ? Tone::Faint : form.tone};
}

constexpr std::string_view kSides[] = {"robot", "box", "network", "Command Post"};

std::string why_of(const alarms::Alarm& alarm) {
  std::string text(kSides[static_cast<std::size_t>(alarm.side)]);
  if (!alarm.why.empty()) text += ": " + alarm.why;
  if (alarm.hides > 0) text += " (hides " + std::to_string(alarm.hides) + ")";
  return alarm.acknowledged ? text + " (acknowledged)" : text;
}

std::string alarms_table(const RunView& view, bool colour) {
  Table table({{}, {}, {}, {}});
  for (const alarms::Alarm& alarm : view.alarms) {
    table.add({severity_cell(alarm),
               {alarm.what, Tone::Strong},
               {"for " + duration(view.now - alarm.since)},
               {why_of(alarm)}});
  }
  return table.empty() ? "" : table.written(colour) + '\n';
}

std::string verdict_line(const RunView& view, bool colour) {
  if (view.verdict.what.empty()) return "";
  return "Maps  " + painted(view.verdict.what, tone_of_level(view.verdict.level), colour) + ": " +
         host::escaped(view.verdict.why) + '\n';
}

/// "12:34", "about 12:34"
std::string clock_text(const alarms::ShownClock& shown, double seconds) {
  return (shown.old && shown.runs ? "about " : "") + clock(seconds);
}

/// Remaining time of the run by the settings.
std::string to_go(const RunView& view, const alarms::ShownClock& shown) {
  const double left = static_cast<double>(view.run_seconds) - shown.seconds;
  return clock_text(shown, std::abs(left)) + (left < 0 ? " over time" : " to go");
}

std::string run_line(const RunView& view, bool colour) {
  if (!view.run || !view.run_clock)
    return painted("Run   no status from the Command Post yet", Tone::Warning, colour) + '\n';
  const icd::RunStatus& run = *view.run;
  const alarms::ShownClock& shown = *view.run_clock;
  const Tone tone = shown.old ? Tone::Faint : Tone::Strong;
  std::string text = "Run   " + painted(clock_text(shown, shown.seconds), tone, colour) + "   " +
                     to_go(view, shown) + "   score " + painted(std::to_string(run.score), tone, colour) +
                     "   " + painted(std::to_string(run.remaining_reports), tone, colour) + " reports left";
  if (!run.current_team.empty()) text += "   team " + host::escaped(run.current_team);
  text +=
      painted("   (heard " + duration(shown.age) + " ago)", shown.old ? Tone::Warning : Tone::Faint, colour);
  return text + '\n';
}

std::string link_line(const RunView& view) {
  return "Link  " + decimal(view.sent_mbit, 1) + " of " + decimal(view.budget_mbit, 1) + " Mbit/s   " +
         size(view.queued_bytes) + " of maps queued\n";
}

std::string reports_line(const RunView& view, bool colour) {
  std::map<std::string, int> states;
  std::set<std::string> urgent;
  for (const api::ReportRow& report : view.reports) {
    const std::string state = life_of(report);
    ++states[state];
    if (needs_the_operator(report)) urgent.insert(state);
  }
  std::string text = states.empty() ? "Reports  0" : "Reports";
  for (const auto& [state, number] : states) {
    const std::string words = std::to_string(number) + " " + host::escaped(state);
    text += "  " + painted(words, urgent.contains(state) ? Tone::Bad : Tone::Plain, colour);
  }
  return text + '\n';
}

std::string last_answer(const api::EndpointRow& endpoint) {
  if (endpoint.last_status == 0) return "";
  std::string text = "last answer: " + answer_of(endpoint.last_status, "");
  if (endpoint.answer_ms)
    text += " in " + decimal(*endpoint.answer_ms, *endpoint.answer_ms < 10 ? 1 : 0) + " ms";
  return text;
}

std::string endpoints_table(const RunView& view, bool colour) {
  Table table({{}, {}, {}, {}, {}});
  for (const api::EndpointRow& endpoint : view.endpoints) {
    table.add({{endpoint.name, Tone::Strong},
               {endpoint.address},
               {endpoint.word, tone_of_level(endpoint.level)},
               {last_answer(endpoint)},
               {endpoint.trouble, Tone::Bad}});
  }
  return table.empty() ? "" : "\nCommand Post\n" + table.written(colour);
}

std::string ago(double seconds) {
  return duration(seconds) + " ago";
}

/// Size of the last sent map. The last accepted map may be another.
std::string sent_size(const api::ActivityRow& row) {
  return row.age ? size(row.bytes_sent) : "";
}

/// With the mode of clouds, and the points that were not sent.
std::string kind_of(const api::ActivityRow& row) {
  std::string kind = row.kind;
  if (!row.clouds.empty()) kind += ", " + row.clouds;
  if (!row.precision.empty() && row.precision != "exact") kind += ", to " + row.precision;
  if (row.points_left_out > 0) kind += ", " + std::to_string(row.points_left_out) + " points left out";
  if (row.no_valid_point > 0) kind += ", " + std::to_string(row.no_valid_point) + " without a valid point";
  if (row.invisible > 0) kind += ", " + std::to_string(row.invisible) + " invisible";
  return kind;
}

std::string activities_table(const RunView& view, bool colour) {
  Table table({{"robot"},
               {"kind"},
               {"arriving"},
               {"accepted", Align::Right},
               {"sent", Align::Right},
               {"queued", Align::Right},
               {"no room", Align::Right},
               {"age", Align::Right},
               {"size", Align::Right},
               {"last answer"}});
  for (const api::ActivityRow& row : view.activities) {
    table.add({{row.robot.empty() ? "(all)" : row.robot, Tone::Strong},
               {kind_of(row)},
               {row.word, tone_of_level(row.level)},
               {std::to_string(row.accepted)},
               {std::to_string(row.forwarded)},
               {std::to_string(row.queued)},
               {row.no_room == 0 ? "" : std::to_string(row.no_room), Tone::Warning},
               {row.age ? duration(*row.age) : "never"},
               {sent_size(row)},
               {answer_of(row.last_status, row.last_sentence),
                row.level == alarms::Level::Bad ? Tone::Bad : Tone::Plain}});
  }
  return table.empty() ? "" : "\nMaps, states and markers\n" + table.written(colour);
}

std::string refusals_table(const RunView& view, bool colour) {
  static constexpr std::size_t kShown = 5;
  Table table({{}, {}, {}, {}, {}});
  for (std::size_t i = 0; i < view.refusals.size() && i < kShown; ++i) {
    const api::RefusalRow& refusal = view.refusals[i];
    table.add({{ago(view.now - refusal.at), Tone::Faint},
               {refusal.sender},
               {refusal.uri},
               {std::to_string(refusal.status), Tone::Warning},
               {refusal.sentence}});
  }
  return table.empty() ? "" : "\nRejected from clients, newest first\n" + table.written(colour);
}

}  // namespace

Tone tone_of_level(alarms::Level level) {
  constexpr Tone kTones[] = {Tone::Faint, Tone::Good, Tone::Warning, Tone::Bad};
  return kTones[static_cast<std::size_t>(level)];
}

std::string status_text(const RunView& view, bool colour) {
  return alarms_table(view, colour) + run_line(view, colour) + verdict_line(view, colour) + link_line(view) +
         reports_line(view, colour) + endpoints_table(view, colour) + activities_table(view, colour) +
         refusals_table(view, colour);
}

Result<Outcome> status(const Call& call) {
  const auto run = ADIT_TRY(fetch<RunView>(call.adit, "/adit/run"));
  const auto update = fetch<api::UpdateView>(call.adit, "/adit/update");
  const bool is_fine = std::ranges::none_of(run.row.alarms, alarms::calls);
  return printed(call, run.json,
                 status_text(run.row, call.console.colour) +
                     (update ? newer_lines(update->row)
                             : line("cannot ask for newer versions: ", update.error().sentence)),
                 is_fine ? Exit::Fine : Exit::Attention);
}

}  // namespace adit::cli
