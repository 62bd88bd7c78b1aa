#include <algorithm>
#include <utility>

#include "alarms/board.hpp"
#include "api/box.hpp"
#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "cli/handlers.hpp"
#include "cli/status_text.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

using codec::Value;

constexpr std::chrono::seconds kEvery{1};
constexpr std::chrono::seconds kPacked{60};  // the box packs the bundle first

/// RFC 3986 2.1.
std::string percent_encoded(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    if (icd::is_letter_or_digit(c)) {
      encoded += c;
    } else {
      encoded.append("%").append(icd::hex(static_cast<std::uint8_t>(c)));
    }
  }
  return encoded;
}

Tone tone_of_record(const api::LogRecord& record) {
  if (record.level == "error") return Tone::Bad;
  return record.level == "warning" ? Tone::Warning : Tone::Plain;
}

std::string text_of(const api::LogPage& page, bool colour) {
  std::string text;
  for (const api::LogRecord& record : page.records) {
    std::string fields;
    for (const auto& [name, value] : record.fields) fields.append(" ").append(name).append("=").append(value);
    text += paint(api::iso_time(record.at), Tone::Faint, colour) + ' ' +
            paint(host::escape(record.level), tone_of_record(record), colour) + ": " +
            line(record.message, fields);
  }
  return text;
}

std::string log_target(const Options& options, std::uint64_t since) {
  std::string target = icd::sentence("/adit/log?since=", since);
  if (!options.level.empty()) target += "&level=" + percent_encoded(options.level);
  if (!options.text.empty()) target += "&text=" + percent_encoded(options.text);
  return target;
}

/// With --json a line for each record.
std::string records_text(const Call& call, const api::LogPage& page) {
  if (!call.options.json) return text_of(page, call.console.colour);
  std::string lines;
  for (const api::LogRecord& record : page.records) lines += codec::to_json(record) + '\n';
  return lines;
}

std::string alarms_text(const api::RunView& view, bool colour) {
  std::string text;
  for (const alarms::Alarm& alarm : view.alarms) {
    const Tone tone = alarms::calls(alarm) ? Tone::Bad : Tone::Warning;
    text += paint(host::escape(alarms::line_of(alarm)), tone, colour) +
            line(alarm.acknowledged ? "  (acknowledged)" : "") +
            line("  since ", api::iso_time(alarm.since), ", id ", alarm.id);
    if (!alarm.details.empty()) text += line("  ", alarm.details);
  }
  return text.empty() ? "no alarm\n" : text;
}

}  // namespace

Result<Outcome> show_log(const Call& call) {
  std::uint64_t last = 0;
  std::string trouble;
  for (bool is_first = true;; is_first = false) {
    const auto page = fetch<api::LogPage>(call.adit, log_target(call.options, last));
    if (!page && is_first) return std::unexpected(page.error());
    const std::string why = page ? "" : page.error().sentence;
    if (std::exchange(trouble, why) != why && !call.options.json)
      call.console.print(why.empty() ? "Adit answers again\n" : line(why));
    if (page) {
      call.console.print(records_text(call, page->row));
      last = page->row.last < last ? 0 : page->row.last;  // less: aditd was restarted
    }
    if (!call.options.follow) return Outcome{};
    std::this_thread::sleep_for(kEvery);
  }
}

Result<Outcome> fetch_bundle(const Call& call) {
  const std::string given = call.options.argument();
  const std::string file = given.empty() ? "adit-support.tar.gz" : given;
  const auto bundle = ADIT_TRY(get(call.adit, "/adit/bundle", kPacked));
  ADIT_TRY(write_to(file, bundle));
  const Value json{Value::Object{{"file", {file}}, {"bytes", {std::uint64_t{bundle.size()}}}}};
  return print_result(call, codec::write_json(json),
                      line("wrote the support bundle to ", file, " (", icd::size_text(bundle.size()),
                           "; without tokens and passwords)"));
}

Result<Outcome> list_alarms(const Call& call) {
  const auto view = ADIT_TRY(fetch<api::RunView>(call.adit, "/adit/run")).row;
  return print_result(call, codec::to_json(view.alarms), alarms_text(view, call.console.colour),
                      std::ranges::any_of(view.alarms, alarms::calls) ? Exit::Attention : Exit::Fine);
}

Result<Outcome> acknowledge(const Call& call) {
  const std::string id = call.options.argument();
  return act(call,
             {.target = "/adit/alarms/acknowledge",
              .check = "adit alarms",
              .body = codec::write_json({Value::Object{{"id", {id}}}})},
             line("alarm ", id, " is acknowledged: it is quiet until it gets worse or begins again"));
}

Result<Outcome> show_version(const Options& options, const Console& console) {
  const auto adit = adit_of(options, console);
  const auto about = adit ? fetch<api::About>(*adit, "/adit/about") : std::unexpected(adit.error());
  if (!about) {
    Outcome outcome = failure_outcome(about.error());
    if (!options.json) outcome.out = line("adit ", ADIT_VERSION);
    return outcome;
  }
  const api::About& box = about->row;
  Facts facts;
  facts.add("adit", ADIT_VERSION, Tone::Strong);
  facts.add("box", box.version, Tone::Strong);
  facts.add("build", box.build);
  if (box.board) facts.add("board", box.board->title);
  facts.add("model", box.model);
  facts.add("kernel", box.kernel);
  facts.add("runs for", duration(box.uptime));
  return print_result({*adit, options, console}, about->json, facts.to_text(console.colour));
}

}  // namespace adit::cli
