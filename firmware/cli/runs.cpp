#include "cli/runs.hpp"

#include <algorithm>
#include <fstream>

#include "api/kept_runs.hpp"
#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "cli/ask.hpp"
#include "cli/reading.hpp"
#include "cli/table.hpp"
#include "cli/words.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::cli {
namespace {

using Align = Table::Align;
using api::RunRow;

constexpr std::chrono::seconds kPrinted{60};  // a run is read from the disk for it, and drawn

std::string number_or_none(const std::optional<std::int64_t>& number) {
  return number ? std::to_string(*number) : "";
}

/// Unknown for the first run of a box.
std::string begin_of(const RunRow& run) {
  return run.began > 0 ? api::iso_time(run.began) : "";
}

std::string course_of(const RunRow& run) {
  return run.course.empty() ? run.post : run.course;
}

std::string table_of(const api::RunList& list, bool colour) {
  std::string text;
  if (!list.trouble.empty())
    text = painted("Runs are not being kept: " + host::escaped(list.trouble), Tone::Bad, colour) + '\n';
  if (list.runs.empty()) return text + "0 runs are kept\n";
  Table table({{"key", Align::Right},
               {"began"},
               {"course"},
               {"score", Align::Right},
               {"reports left", Align::Right},
               {"robots", Align::Right},
               {"size", Align::Right},
               {""}});
  for (const RunRow& run : list.runs) {
    table.add({{run.key, Tone::Strong},
               {begin_of(run)},
               {course_of(run)},
               {number_or_none(run.score), Tone::Strong},
               {number_or_none(run.remaining_reports)},
               {std::to_string(run.robots.size())},
               {size(run.bytes)},
               {run.is_present ? "now" : "", Tone::Good}});
  }
  return text + table.written(colour);
}

Outcome list_runs(const Adit& adit, const Options& options, bool colour) {
  const auto json = get(adit, "/adit/runs");
  if (!json) return unable(json.error());
  const auto list = read<api::RunList>(adit, *json);
  if (!list) return unable(list.error());
  return {Exit::Fine, options.json ? *json + '\n' : table_of(*list, colour), ""};
}

std::string text_of(const RunRow& run, bool colour) {
  std::string robots;
  for (const std::string& name : run.robots) robots.append(robots.empty() ? "" : ", ").append(name);
  Table table({{}, {}});
  const auto add = [&table](const char* name, const std::string& text, Tone tone = Tone::Plain) {
    if (!text.empty()) table.add({{name, Tone::Faint}, {text, tone}});
  };
  add("run", run.key + (run.is_present ? " (now)" : ""), Tone::Strong);
  add("name", run.id);
  add("course", run.course);
  add("Command Post", run.post);
  add("team", run.team);
  add("began", begin_of(run));
  add("last", api::iso_time(run.last));
  add("score", number_or_none(run.score), Tone::Strong);
  add("reports left", number_or_none(run.remaining_reports));
  add("robots", robots);
  add("size", size(run.bytes));
  return table.written(colour);
}

/// A run's key is part of a path: digits, and a hyphen where two runs have the same number.
bool is_key(const std::string& key) {
  return !key.empty() && key.find_first_not_of("0123456789-") == std::string::npos;
}

std::string path_of(const Options& options) {
  return "/adit/runs/" + options.run_key;
}

Outcome show(const Adit& adit, const Options& options, bool colour) {
  const auto json = find(adit, path_of(options));
  if (!json) return unable(json.error());
  const auto run = read<RunRow>(adit, *json);
  if (!run) return unable(run.error());
  return {Exit::Fine, options.json ? *json + '\n' : text_of(*run, colour), ""};
}

Outcome report(const Adit& adit, const Options& options) {
  const auto html = find(adit, path_of(options) + "/report.html", kPrinted);
  if (!html) return unable(html.error());
  if (options.to.empty()) return {Exit::Fine, *html, ""};
  std::ofstream file(options.to, std::ios::binary);
  if (!file || !(file << *html).flush()) return unable(options.to + ": cannot be written");
  if (!options.json)
    return {
        Exit::Fine,
        icd::sentence("wrote the report of run ", options.run_key, " to ") + host::escaped(options.to) + '\n',
        ""};
  const codec::Value said{codec::Value::Object{
      {"key", {options.run_key}}, {"file", {options.to}}, {"bytes", {std::uint64_t{html->size()}}}}};
  return {Exit::Fine, codec::write_json(said) + '\n', ""};
}

/// Why it is not deleted; nothing if the operator confirms.
std::optional<Failure> doubt(const Adit& adit, const Options& options, const Console& console) {
  const auto json = find(adit, path_of(options));
  if (!json) return json.error();
  const auto run = read<RunRow>(adit, *json);
  if (!run) return Failure{Exit::Unable, run.error()};
  const std::string began = run->began > 0 ? icd::sentence("began ", begin_of(*run), ", ") : "";
  const std::string score = run->score ? icd::sentence("score ", *run->score, ", ") : "";
  const std::string why =
      icd::sentence("run ", run->key, " (", began, score, size(run->bytes),
                    "): its map, tracks and plots will be deleted for good; its reports stay in the ledger.");
  const auto meant = console.ask(host::escaped(why) + "\nDelete it?");
  if (!meant) return Failure{Exit::Attention, why + " It was not deleted; to delete it, add --yes"};
  if (!*meant) return Failure{Exit::Attention, "run " + run->key + " was not deleted"};
  return std::nullopt;
}

Outcome remove(const Adit& adit, const Options& options, const Console& console) {
  if (!options.yes) {
    if (const auto why = doubt(adit, options, console)) return unable(*why);
  }
  const auto done = post(adit, path_of(options) + "/delete", "", "adit runs");
  if (!done) return unable(done.error());
  return {Exit::Fine, options.json ? *done + '\n' : "run " + options.run_key + " was deleted\n", ""};
}

std::string json_of(const api::RunView& view) {
  codec::Value::Object run{{"run", {view.run_number}}, {"name", {view.run_id}}};
  if (view.run) {
    run.emplace_back("team", codec::Value{view.run->current_team});
    run.emplace_back("run_clock", codec::Value{view.run->run_clock});
    run.emplace_back("score", codec::Value{view.run->score});
    run.emplace_back("remaining_reports", codec::Value{view.run->remaining_reports});
  }
  return codec::write_json({std::move(run)}) + '\n';
}

std::string text_of(const api::RunView& view, bool colour) {
  Table table({{}, {}});
  const auto add = [&table](const char* name, const std::string& text) {
    if (!text.empty()) table.add({{name, Tone::Faint}, {text, Tone::Strong}});
  };
  add("run", std::to_string(view.run_number));
  add("name", view.run_id);
  if (!view.run) return table.written(colour) + "no status from the Command Post yet\n";
  add("team", view.run->current_team);
  add("clock", clock(view.run->run_clock));
  add("score", std::to_string(view.run->score));
  add("reports left", std::to_string(view.run->remaining_reports));
  return table.written(colour);
}

}  // namespace

Outcome present_run(const Options& options, bool colour) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  const auto view = run_view(*adit);
  if (!view) return unable(view.error());
  return {Exit::Fine, options.json ? json_of(*view) : text_of(*view, colour), ""};
}

Outcome runs(const Options& options, const Console& console) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (options.verb == Verb::List) return list_runs(*adit, options, console.colour);
  if (!is_key(options.run_key))
    return unable(Failure{Exit::Attention, "there is no run " + options.run_key + ": see adit runs"});
  if (options.verb == Verb::Show) return show(*adit, options, console.colour);
  if (options.verb == Verb::Report) return report(*adit, options);
  return remove(*adit, options, console);
}

}  // namespace adit::cli
