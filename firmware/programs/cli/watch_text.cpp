#include "cli/watch_text.hpp"

#include <algorithm>
#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/board.hpp"
#include "api/reports_csv.hpp"
#include "cli/reports_text.hpp"
#include "cli/status_text.hpp"
#include "cli/words.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::cli {
namespace {

/// Lines that begin with the time.
class Lines {
 public:
  Lines(api::Time at, bool colour) : at_(at), colour_(colour) {}
  void add(const std::string& what, Tone tone = Tone::Plain) {
    text_ += painted(api::iso_time(at_), Tone::Faint, colour_) + "  " +
             painted(host::escaped(what), tone, colour_) + '\n';
  }
  const std::string& text() const { return text_; }

 private:
  api::Time at_;
  bool colour_;
  std::string text_;
};

void alarms_told(const api::RunView& before, const api::RunView& now, Lines& lines) {
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
std::string told_of_run(const api::RunView& view) {
  if (!view.run) return "no status from the Command Post yet";
  const icd::RunStatus& run = *view.run;
  return icd::sentence("score ", run.score, ", ", run.remaining_reports, " reports left",
                       run.current_team.empty() ? "" : ", team ", run.current_team);
}

void run(const api::RunView& before, const api::RunView& now, Lines& lines) {
  if (now.run_number != before.run_number) lines.add(icd::sentence("run ", now.run_number, " begins"));
  const std::string told = told_of_run(now);
  if (told != told_of_run(before))
    lines.add(now.run ? icd::sentence("run ", clock(now.run->run_clock), ": ", told) : "run: " + told);
}

void reports(const api::RunView& before, const api::RunView& now, Lines& lines) {
  for (const api::ReportRow& report : now.reports) {
    const auto was = std::ranges::find(before.reports, report.number, &api::ReportRow::number);
    const std::string life = life_of(report);
    if (was != before.reports.end() && life_of(*was) == life) continue;
    const std::string why = report.note.empty() ? "" : " (" + report.note + ")";
    const std::string score = gained_by(report).empty() ? "" : ", score " + gained_by(report);
    lines.add(icd::sentence("report ", report.number, " ", report.type, ": ", life, score, why),
              tone_of(report));
  }
}

std::string state_of(const api::EndpointRow& endpoint) {
  return endpoint.trouble.empty() ? endpoint.word : endpoint.word + ", " + endpoint.trouble;
}

void endpoints(const api::RunView& before, const api::RunView& now, Lines& lines) {
  for (const api::EndpointRow& endpoint : now.endpoints) {
    const auto was = std::ranges::find(before.endpoints, endpoint.name, &api::EndpointRow::name);
    if (was != before.endpoints.end() && state_of(*was) == state_of(endpoint)) continue;
    lines.add(endpoint.name + " endpoint: " + state_of(endpoint), tone_of_level(endpoint.level));
  }
}

constexpr std::string_view kArrives = "arrives", kNotArriving = "NOT ARRIVING";

/// In the order of alarms::Arrival. Late is shown as arriving, because robots that share the link are late in
/// turn.
constexpr std::string_view kTold[] = {"none sent yet", kArrives,     kArrives,     kArrives, kNotArriving,
                                      kNotArriving,    kNotArriving, kNotArriving, kArrives, "silent"};
static_assert(std::size(kTold) == std::size(alarms::kArrivalWords));

std::string_view told_of(const api::ActivityRow& row) {
  return kTold[static_cast<std::size_t>(row.arrival)];
}

void arrivals(const api::RunView& before, const api::RunView& now, Lines& lines) {
  for (const api::ActivityRow& row : now.activities) {
    const auto was = std::ranges::find_if(before.activities, [&row](const api::ActivityRow& each) {
      return each.robot == row.robot && each.kind == row.kind;
    });
    const std::string_view told = told_of(row);
    if (was != before.activities.end() && told_of(*was) == told) continue;
    const std::string why = told == kNotArriving ? ": " + row.last_sentence : "";
    lines.add(icd::sentence(row.robot.empty() ? "all robots" : row.robot, ", ", row.kind, ": ", told, why),
              tone_of_level(row.level));
  }
}

/// The end of the colour sequence (ECMA-48, CSI ... m) at `at`, or `at` if there is none.
std::size_t behind_colour(std::string_view line, std::size_t at) {
  if (!line.substr(at).starts_with("\033[")) return at;
  const std::size_t end = line.find('m', at);
  return end == std::string_view::npos ? line.size() : end + 1;
}

bool continues(char byte) {  // UTF-8 continuation byte
  return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80u;
}

std::string cut(std::string_view line, std::size_t columns) {
  std::string text;
  std::size_t shown = 0;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = behind_colour(line, at);
    if (end == at) {
      if (++shown > columns) return text + "\033[0m";
      do ++end;
      while (end < line.size() && continues(line[end]));
    }
    text += line.substr(at, end - at);
    at = end;
  }
  return text;
}

}  // namespace

std::string changes_text(const api::RunView& before, const api::RunView& now, bool colour) {
  Lines lines(now.now, colour);
  alarms_told(before, now, lines);
  run(before, now, lines);
  endpoints(before, now, lines);
  reports(before, now, lines);
  arrivals(before, now, lines);
  return lines.text();
}

std::string fitted(std::string_view text, std::size_t rows, std::size_t columns) {
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
