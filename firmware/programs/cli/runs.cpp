#include "api/kept_runs.hpp"
#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

using api::RunRow;

constexpr std::chrono::seconds kPrinted{60};  // the box reads and draws the run first

std::string number_or_none(const std::optional<std::int64_t>& number) {
  return number ? std::to_string(*number) : "";
}

/// "" for a box's first run, whose start is unknown.
std::string begin_of(const RunRow& run) {
  return run.began > 0 ? api::iso_time(run.began) : "";
}

std::string text_of(const api::RunList& list, bool colour) {
  std::string text;
  if (!list.trouble.empty())
    text = paint("Runs are not being kept: " + host::escape(list.trouble), Tone::Bad, colour) + '\n';
  if (list.runs.empty()) return text + "0 runs are kept\n";
  const std::vector<ColumnOf<RunRow>> columns = {
      {"key", [](const RunRow& run) { return Cell(run.key, Tone::Strong); }, kRight},
      {"began", begin_of},
      {"course", [](const RunRow& run) { return run.course.empty() ? run.post : run.course; }},
      {"score", [](const RunRow& run) { return Cell(number_or_none(run.score), Tone::Strong); }, kRight},
      {"reports left", [](const RunRow& run) { return number_or_none(run.remaining_reports); }, kRight},
      {"robots", [](const RunRow& run) { return std::to_string(run.robots.size()); }, kRight},
      {"size", [](const RunRow& run) { return icd::size_text(run.bytes); }, kRight},
      {"", [](const RunRow& run) { return Cell(run.is_present ? "now" : "", Tone::Good); }}};
  return text + table_of(list.runs, columns, colour);
}

std::string text_of(const RunRow& run, bool colour) {
  Facts facts;
  facts.add("run", run.key + (run.is_present ? " (now)" : ""), Tone::Strong);
  facts.add("name", run.id);
  facts.add("course", run.course);
  facts.add("Command Post", run.post);
  facts.add("team", run.team);
  facts.add("began", begin_of(run));
  facts.add("last", api::iso_time(run.last));
  facts.add("score", number_or_none(run.score), Tone::Strong);
  facts.add("reports left", number_or_none(run.remaining_reports));
  facts.add("robots", icd::join_words(run.robots));
  facts.add("size", icd::size_text(run.bytes));
  return facts.to_text(colour);
}

std::string json_of(const api::RunView& view) {
  codec::Value::Object run{{"run", {view.run_number}}, {"name", {view.run_id}}};
  if (view.run) {
    run.emplace_back("team", codec::Value{view.run->current_team});
    run.emplace_back("run_clock", codec::Value{view.run->run_clock});
    run.emplace_back("score", codec::Value{view.run->score});
    run.emplace_back("remaining_reports", codec::Value{view.run->remaining_reports});
  }
  return codec::write_json({std::move(run)});
}

std::string text_of(const api::RunView& view, bool colour) {
  Facts facts;
  facts.add("run", std::to_string(view.run_number), Tone::Strong);
  facts.add("name", view.run_id, Tone::Strong);
  if (!view.run) return facts.to_text(colour) + "no status from the Command Post yet\n";
  facts.add("team", view.run->current_team, Tone::Strong);
  facts.add("clock", clock(view.run->run_clock), Tone::Strong);
  facts.add("score", std::to_string(view.run->score), Tone::Strong);
  facts.add("reports left", std::to_string(view.run->remaining_reports), Tone::Strong);
  return facts.to_text(colour);
}

/// A key has digits, and a hyphen if two runs share a number.
Result<std::string> path_of(const std::string& key) {
  if (!key.empty() && key.find_first_not_of("0123456789-") == std::string::npos) return "/adit/runs/" + key;
  return to_failure("there is no run " + key + ": see adit runs", Exit::Attention);
}

Result<void> confirm_deletion(const Call& call, const std::string& path) {
  const RunRow run = ADIT_TRY(fetch<RunRow>(call.adit, path)).row;
  const std::string began = run.began > 0 ? icd::sentence("began ", begin_of(run), ", ") : "";
  const std::string score = run.score ? icd::sentence("score ", *run.score, ", ") : "";
  return confirm(
      call.options, call.console,
      icd::sentence("run ", run.key, " (", began, score, icd::size_text(run.bytes),
                    "): its map, tracks and plots will be deleted for good; its reports stay in the ledger."),
      "Delete it?", "run " + run.key + " was not deleted");
}

}  // namespace

Result<Outcome> show_present_run(const Call& call) {
  const api::RunView view = ADIT_TRY(fetch<api::RunView>(call.adit, "/adit/run")).row;
  return print_result(call, json_of(view), text_of(view, call.console.colour));
}

Result<Outcome> list_runs(const Call& call) {
  return show<api::RunList>(call, "/adit/runs", text_of);
}

Result<Outcome> show_run(const Call& call) {
  const auto path = ADIT_TRY(path_of(call.options.argument()));
  return show<RunRow>(call, path, text_of);
}

Result<Outcome> print_run(const Call& call) {
  const std::string key = call.options.argument(), to = call.options.to;
  const auto path = ADIT_TRY(path_of(key));
  const auto html = ADIT_TRY(get(call.adit, path + "/report.html", kPrinted));
  if (to.empty()) return Outcome{Exit::Fine, html, ""};
  ADIT_TRY(write_to(to, html));
  const codec::Value json{
      codec::Value::Object{{"key", {key}}, {"file", {to}}, {"bytes", {std::uint64_t{html.size()}}}}};
  return print_result(call, codec::write_json(json), line("wrote the report of run ", key, " to ", to));
}

Result<Outcome> delete_run(const Call& call) {
  const std::string key = call.options.argument();
  const auto path = ADIT_TRY(path_of(key));
  if (!call.options.yes) {
    ADIT_TRY(confirm_deletion(call, path));
  }
  return act(call, {.target = path + "/delete", .check = "adit runs"}, "run " + key + " was deleted\n");
}

}  // namespace adit::cli
