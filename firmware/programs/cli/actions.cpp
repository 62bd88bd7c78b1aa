#include <algorithm>
#include <map>
#include <ranges>

#include "api/run_view.hpp"
#include "cli/handlers.hpp"
#include "codec/json.hpp"
#include "command_line/number.hpp"
#include "dispatch/report_life.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::cli {
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

/// Asks the operator for confirmation if the report is in doubt.
Result<void> confirm_sending(const Call& call, const std::string& target, std::int64_t number) {
  const api::ReportRow report = ADIT_TRY(fetch<api::ReportDetail>(call.adit, target)).row.row;
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
  const auto answer = ADIT_TRY(
      told<DecidedReport>(call.adit, post(call.adit, {.target = target + "/" + verb, .check = check})));
  const char* const done = std::ranges::find(kDecisions, verb, &Decision::verb)->done;
  const std::string moved = is_new ? std::to_string(answer.row.report) : "";
  return printed(call, answer.json, icd::sentence("report ", number, done, moved, "\n"));
}

}  // namespace

constexpr codec::Row DecidedReport::kRow = {"", kDecided};
constexpr codec::Row BegunRun::kRow = {"", kBegun};

Result<Outcome> decide_on_reports(const Call& call) {
  return act_on_each(call, [&call](std::int64_t number) { return decide_on(call, number); });
}

Result<Outcome> correct_report(const Call& call) {
  const std::vector<std::string>& words = call.options.arguments;
  std::uint64_t number = 0;
  if (const auto wrong = command_line::read_number(words.front(), std::uint64_t{1}, kMostNumber, number))
    return failed("the report's number: " + *wrong);
  const std::string target = icd::sentence("/adit/reports/", number);
  const auto now = ADIT_TRY(fetch<api::ReportDetail>(call.adit, target));
  const api::ReportRow& report = now.row.row;
  std::map<std::string, codec::Value> body{{"type", {report.type}}};
  for (const auto& [name, axis] : kAxes) {
    if (report.position) body[name] = {(*report.position).*axis};
  }
  for (const std::string& word : words | std::views::drop(1)) {
    const std::size_t end = word.find('=');
    const std::string name = word.substr(0, end),
                      value = end == std::string::npos ? "" : word.substr(end + 1);
    const bool is_axis = std::ranges::find(kAxes, name, &Axis::name) != std::end(kAxes);
    if (end == std::string::npos || (name != "type" && !is_axis))
      return failed("'" + word + "': expected type=, x=, y= or z=");
    double metres = 0;
    if (const auto wrong = is_axis ? command_line::read_number(value, -kFar, kFar, metres) : std::nullopt)
      return failed(name + ": " + *wrong);
    body[name] = is_axis ? codec::Value{metres} : codec::Value{value};
  }
  const auto answer = ADIT_TRY(told<DecidedReport>(
      call.adit,
      post(call.adit, {.target = target + "/correct",
                       .check = icd::sentence("adit reports show ", number),
                       .body = codec::write_json({codec::Value::Object(body.begin(), body.end())})})));
  return printed(call, answer.json,
                 icd::sentence("report ", number, " is corrected as report ", answer.row.report, "\n"));
}

Result<Outcome> begin_run(const Call& call) {
  const auto answer =
      ADIT_TRY(told<BegunRun>(call.adit, post(call.adit, {.target = "/adit/runs", .check = "adit reports"})));
  return printed(call, answer.json,
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

}  // namespace adit::cli
