#include <algorithm>

#include "api/kept_runs.hpp"
#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "api/settings_rows.hpp"
#include "cli/contexts.hpp"
#include "cli/handlers.hpp"
#include "cli/settings.hpp"
#include "cli/status_text.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

/// A possible word and its meaning.
struct Candidate {
  std::string word, what;
};

/// Whether the word has no special characters of shells.
bool is_plain(std::string_view word) {
  return !word.empty() && word.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                              "0123456789._-[]:") == std::string_view::npos;
}

std::string lines(const std::vector<Candidate>& all) {
  std::string text;
  for (const Candidate& each : all) {
    if (is_plain(each.word)) text.append(each.word).append("\t").append(host::escape(each.what)).append("\n");
  }
  return text;
}

std::string json_of(const std::vector<Candidate>& all) {
  codec::Value::Array list;
  for (const Candidate& each : all)
    list.push_back({codec::Value::Object{{"word", {each.word}}, {"what", {each.what}}}});
  return codec::write_json({list});
}

/// Prints the words that `candidates_of` finds in Adit's answer.
template <class Row>
Result<Outcome> list_names(const Call& call, const char* target,
                           const std::function<std::vector<Candidate>(const Row&)>& candidates_of) {
  const auto told = ADIT_TRY(fetch<Row>(call.adit, target));
  const auto all = candidates_of(told.row);
  return print_result(call, json_of(all), lines(all));
}

}  // namespace

Result<Outcome> complete_reports(const Call& call) {
  using Reports = std::vector<facts::ReportRow>;
  const std::string word = call.options.argument();
  return list_names<Reports>(call, "/adit/reports", [&word](const Reports& reports) {
    std::vector<Candidate> all;
    for (const facts::ReportRow& report : reports) {
      if (word.empty() || word == "show" || std::ranges::count(verbs_for(report), word) > 0)
        all.push_back({std::to_string(report.number), report.type + ", " + report_state(report)});
    }
    return all;
  });
}

Result<Outcome> complete_rejected(const Call& call) {
  return list_names<api::RunView>(call, "/adit/run", [](const api::RunView& view) {
    std::vector<Candidate> all;
    all.reserve(view.rejected.size());
    for (const facts::RejectedRow& row : view.rejected)
      all.push_back({std::to_string(row.number), row.kind + (row.robot.empty() ? "" : " of " + row.robot)});
    return all;
  });
}

Result<Outcome> complete_courses(const Call& call) {
  const auto setup = ADIT_TRY(fetch<api::SetupView>(call.adit, "/adit/settings"));
  const auto settings = ADIT_TRY(settings_in(setup.row));
  std::vector<Candidate> all;
  all.reserve(settings.courses.size());
  for (const settings::Course& course : settings.courses)
    all.push_back({course.name, course.scoring.address});
  return print_result(call, json_of(all), lines(all));
}

Result<Outcome> complete_runs(const Call& call) {
  return list_names<api::RunList>(call, "/adit/runs", [](const api::RunList& list) {
    std::vector<Candidate> all;
    all.reserve(list.runs.size());
    for (const api::RunRow& run : list.runs)
      all.push_back({run.key, run.is_present ? "the present run" : api::iso_time(run.began)});
    return all;
  });
}

namespace {

/// The words of a choice, or the default.
std::vector<Candidate> values_of(const api::KeyRow& key) {
  std::vector<Candidate> all;
  for (const std::string& word : key.words.value_or(std::vector<std::string>())) all.push_back({word, ""});
  if (key.kind == "flag") all = {{"true", ""}, {"false", ""}};
  const std::string usual = plain(key.default_value);
  const auto listed = std::ranges::find(all, usual, &Candidate::word);
  if (listed != all.end()) {
    listed->what = "the default";
  } else {
    all.push_back({usual, "the default; allowed: " + key.range});
  }
  return all;
}

/// "robots[].alias" of "robots[ugv1].alias".
std::string pattern_of(const std::string& path) {
  std::string pattern;
  bool inside = false;
  for (const char c : path) {
    if (c == ']') inside = false;
    if (!inside) pattern += c;
    if (c == '[') inside = true;
  }
  return pattern;
}

}  // namespace

Result<Outcome> complete_tokens(const Call& call) {
  return list_names<api::SetupView>(call, "/adit/settings", [](const api::SetupView& setup) {
    std::vector<Candidate> all;
    all.reserve(setup.tokens.size());
    for (const auto& [name, set, warning] : setup.tokens) all.push_back({name, set ? "set" : "not set"});
    return all;
  });
}

Result<Outcome> complete_alarms(const Call& call) {
  return list_names<api::RunView>(call, "/adit/run", [](const api::RunView& view) {
    std::vector<Candidate> all;
    all.reserve(view.alarms.size());
    for (const alarms::Alarm& alarm : view.alarms) all.push_back({alarm.id, alarms::line_of(alarm)});
    return all;
  });
}

Result<Outcome> complete_contexts(const Options& options, const Console& /*console*/) {
  const auto contexts = load_contexts(contexts_file());
  if (!contexts) return to_failure(contexts.error());
  std::vector<Candidate> all;
  all.reserve(contexts->all.size());
  for (const Context& each : contexts->all) all.push_back({each.name, each.at});
  return Outcome{Exit::Fine, options.json ? json_of(all) + '\n' : lines(all), ""};
}

/// Prints each key with the beginning of its meaning.
Result<Outcome> complete_keys(const Options& options, const Console& /*console*/) {
  const auto rows = settings::keys();
  if (const std::string key = options.argument(); !key.empty()) {
    const auto row = std::ranges::find(rows, pattern_of(key), &api::KeyRow::path);
    if (row == rows.end()) return to_failure("no such settings key: " + key);
    const auto values = values_of(*row);
    return Outcome{Exit::Fine, options.json ? json_of(values) + '\n' : lines(values), ""};
  }
  std::vector<Candidate> all;
  all.reserve(rows.size());
  for (const api::KeyRow& key : rows)
    all.push_back({key.path, key.meaning.substr(0, key.meaning.find_first_of(".:;"))});
  return Outcome{Exit::Fine, options.json ? codec::to_json(rows) + '\n' : lines(all), ""};
}

}  // namespace adit::cli
