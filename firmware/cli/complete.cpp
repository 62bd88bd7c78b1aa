#include "cli/complete.hpp"

#include <algorithm>

#include "api/kept_runs.hpp"
#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "api/settings_rows.hpp"
#include "cli/ask.hpp"
#include "cli/reading.hpp"
#include "cli/report_verbs.hpp"
#include "cli/reports_text.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"

namespace adit::cli {
namespace {

/// A word that may stand there, and what it is.
struct Candidate {
  std::string word, what;
};
using Candidates = std::expected<std::vector<Candidate>, std::string>;

bool can_be_said(std::string_view word, const api::ReportRow& report) {
  return word.empty() || word == "show" || std::ranges::count(verbs_for(report), word) > 0;
}

Candidates reports_by_number(const Adit& adit, const std::string& word) {
  const auto json = get(adit, "/adit/reports");
  if (!json) return std::unexpected(json.error());
  const auto rows = read<std::vector<api::ReportRow>>(adit, *json);
  if (!rows) return std::unexpected(rows.error());
  std::vector<Candidate> all;
  for (const api::ReportRow& report : *rows) {
    if (can_be_said(word, report))
      all.push_back({std::to_string(report.number), report.type + ", " + life_of(report)});
  }
  return all;
}

Candidates rejected_by_number(const Adit& adit) {
  const auto json = get(adit, "/adit/run");
  if (!json) return std::unexpected(json.error());
  const auto view = read<api::RunView>(adit, *json);
  if (!view) return std::unexpected(view.error());
  std::vector<Candidate> all;
  for (const api::RejectedRow& row : view->rejected)
    all.push_back({std::to_string(row.number), row.kind + (row.robot.empty() ? "" : " of " + row.robot)});
  return all;
}

Candidates courses_by_name(const Adit& adit) {
  const auto json = get(adit, "/adit/settings");
  if (!json) return std::unexpected(json.error());
  return read<std::vector<Candidate>>(adit, *json, [](const codec::Field& root) {
    const codec::Field settings = root.member("settings"), list = settings.member("courses");
    std::vector<Candidate> all;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const codec::Field course = list.element(i), scoring = course.member("scoring");
      all.push_back({text(course, "name"), text(scoring, "address")});
    }
    return all;
  });
}

Candidates runs_by_key(const Adit& adit) {
  const auto json = get(adit, "/adit/runs");
  if (!json) return std::unexpected(json.error());
  const auto list = read<api::RunList>(adit, *json);
  if (!list) return std::unexpected(list.error());
  std::vector<Candidate> all;
  for (const api::RunRow& run : list->runs)
    all.push_back({run.key, run.is_present ? "the present run" : api::iso_time(run.began)});
  return all;
}

Candidates asked_for(const Options& options) {
  const auto adit = adit_of(options);
  if (!adit) return std::unexpected(adit.error());
  if (options.verb == Verb::Rejected) return rejected_by_number(*adit);
  if (options.verb == Verb::Courses) return courses_by_name(*adit);
  if (options.verb == Verb::Runs) return runs_by_key(*adit);
  return reports_by_number(*adit, options.word);
}

/// Each with the beginning of what it means.
std::vector<Candidate> keys_by_path(const std::vector<api::KeyRow>& rows) {
  std::vector<Candidate> all;
  all.reserve(rows.size());
  for (const api::KeyRow& key : rows)
    all.push_back({key.path, key.meaning.substr(0, key.meaning.find_first_of(".:;"))});
  return all;
}

/// Whether no shell takes it for more than a word.
bool is_plain(std::string_view word) {
  return !word.empty() && word.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                              "0123456789._-[]") == std::string_view::npos;
}

std::string lines(const std::vector<Candidate>& all) {
  std::string text;
  for (const Candidate& each : all) {
    if (is_plain(each.word))
      text.append(each.word).append("\t").append(host::escaped(each.what)).append("\n");
  }
  return text;
}

std::string as_json(const std::vector<Candidate>& all) {
  codec::Value::Array list;
  for (const Candidate& each : all)
    list.push_back({codec::Value::Object{{"word", {each.word}}, {"what", {each.what}}}});
  return codec::write_json({list}) + '\n';
}

}  // namespace

Outcome complete(const Options& options) {
  if (options.verb == Verb::Keys) {
    const auto rows = api::key_rows();
    return {Exit::Fine, options.json ? codec::to_json(rows) + '\n' : lines(keys_by_path(rows)), ""};
  }
  const Candidates all = asked_for(options);
  if (!all) return unable(all.error());
  return {Exit::Fine, options.json ? as_json(*all) : lines(*all), ""};
}

}  // namespace adit::cli
