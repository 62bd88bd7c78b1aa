#include <chrono>

#include "api/settings_rows.hpp"
#include "cli/handlers.hpp"
#include "cli/settings_key.hpp"
#include "cli/table.hpp"
#include "cli/where.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

using codec::Value;

constexpr const char* kSettings = "/adit/settings";
constexpr const char* kSee = "adit settings";
constexpr Waiting kApplied{
    .within = std::chrono::seconds(5), .every = std::chrono::milliseconds(100), .may_be_away = true};

std::string warnings_text(const std::vector<std::string>& warnings, bool colour) {
  std::string text;
  for (const std::string& warning : warnings)
    text += painted("warning", Tone::Warning, colour) + ": " + line(warning);
  return text;
}

/// "  team.listen[0].port  8000 -> 8080"
std::string text_of(const api::ChangesView& view, bool colour) {
  Table table({{}, {}, {}});
  for (const settings::Change& change : view.changes)
    table.add({{change.path, Tone::Strong}, {plain(change.from)}, {"-> " + plain(change.to)}});
  return (table.empty() ? "no changes\n" : table.written(colour)) + warnings_text(view.warnings, colour);
}

std::string errors_text(const std::vector<settings::Error>& errors) {
  std::string text;
  for (const settings::Error& error : errors)
    text += line("adit: ", error.path, error.path.empty() ? "" : ": ", error.what);
  return text;
}

/// The file's JSON; Adit checks its settings.
Result<Value> read_file(const std::string& file) {
  const auto text = host::read_file(file);
  if (!text) return failed(text.error());
  auto value = codec::parse_json(*text);
  if (!value) return failed(file + ": not JSON: " + value.error());
  return *std::move(value);
}

std::string text_of(const api::SetupView& setup, const settings::Settings& settings, bool colour) {
  Table table({{}, {}}), tokens({{}, {}});
  for (const settings::Change& change : settings::changes({}, settings))
    table.add({{change.path, Tone::Strong}, {plain(change.to)}});
  for (const auto& [name, set, warning] : setup.tokens)
    tokens.add({{name, Tone::Strong}, {set ? "set" : "not set", set ? Tone::Good : Tone::Warning}});
  return (setup.saved ? "saved on this box\n" : "as installed\n") + table.written(colour) +
         "all others have their defaults\n\ntokens\n" + tokens.written(colour);
}

/// Adit's check of settings.
Result<Told<api::CheckView>> ask_check(const Adit& adit, const Value& settings) {
  return told<api::CheckView>(
      adit, post(adit, {.target = "/adit/settings/check",
                        .check = kSee,
                        .body = codec::write_json({Value::Object{{"settings", settings}}})}));
}

/// Posts a change and waits until the box uses it. Error: the box reverted the change, or does not use it in
/// time.
Result<Told<api::ChangesView>> change(const Adit& adit, const std::string& target, const Value::Object& body,
                                      const char* check) {
  auto changed = told<api::ChangesView>(
      adit, post(adit, {.target = target, .check = check, .body = codec::write_json({body})}));
  if (!changed || changed->row.changes.empty()) return changed;  // `trouble` may be older
  const auto now = fetch_until<api::SetupView>(adit, kSettings, kApplied,
                                               [](const api::SetupView& setup) { return !setup.applying; });
  if (!now) {
    const std::string& why = now.error().sentence;
    return failed("the change was accepted, but is not seen in use" +
                  (why.empty() ? "" : "; at its new address? " + why));
  }
  if (now->row.trouble.empty()) return changed;
  return failed(now->row.trouble, Exit::Attention);
}

/// VALUE of the command line: JSON, or a text without quotes. `before`: the present value.
Value value_in(const std::string& text, const Value& before) {
  auto value = codec::parse_json(text);
  const auto is_text = [](const Value& any) { return std::holds_alternative<std::string>(any.is); };
  return value && (!is_text(before) || is_text(*value)) ? *std::move(value) : Value{text};
}

/// Checks the settings and applies them to a box with the settings of `now`.
Result<Outcome> apply(const Call& call, const api::SetupView& now, const Value& settings) {
  const auto checked = ADIT_TRY(ask_check(call.adit, settings));
  if (const auto& errors = checked.row.errors; !errors.empty())
    return Outcome{Exit::Attention, "", errors_text(errors)};
  const auto done =
      ADIT_TRY(change(call.adit, kSettings, {{"settings", settings}, {"base", {now.tag}}}, kSee));
  return printed(call, done.json, text_of(checked.row.changes, call.console.colour));
}

/// "" stands for the endpoints of command_post.
std::string courses_text(const settings::Settings& settings, bool colour) {
  const settings::CommandPost& post = settings.command_post;
  Table table({{"course"}, {"scoring"}, {"mapping"}, {""}});
  std::vector<settings::Course> courses = settings.courses;
  courses.push_back({.name = "", .scoring = post.scoring, .mapping = post.mapping});
  for (const settings::Course& each : courses) {
    table.add({{each.name.empty() ? "\"\"" : each.name, Tone::Strong},
               {written(each.scoring)},
               {written(each.mapping)},
               {each.name == post.course ? "in use" : "", Tone::Good}});
  }
  return table.written(colour);
}

Result<Outcome> list_courses(const Call& call) {
  const auto setup = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  const auto settings = ADIT_TRY(settings_in(setup.row));
  Value all = setup.row.settings;
  const Value* const courses = value_at(all, "courses");
  const Value::Object listed{{"course", {settings.command_post.course}},
                             {"courses", courses == nullptr ? Value{} : *courses}};
  return printed(call, codec::write_json({listed}), courses_text(settings, call.console.colour));
}

}  // namespace

Result<settings::Settings> settings_in(const api::SetupView& setup) {
  auto settings = settings::parse(setup.settings);
  if (!settings) return failed("cannot read Adit's answer: " + settings::sentence_of(settings.error()));
  return *std::move(settings);
}

Result<Outcome> show_settings(const Call& call) {
  const bool colour = call.console.colour;
  const auto setup = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  if (const std::string key = call.options.argument(); !key.empty()) {
    const auto keys = ADIT_TRY(keys_named(setup.row, key));
    return printed(call, codec::write_json(json_of(keys)), text_of(keys, colour));
  }
  const auto settings = ADIT_TRY(settings_in(setup.row));
  return printed(call, setup.json, text_of(setup.row, settings, colour));
}

Result<Outcome> check_settings(const Call& call) {
  const auto settings = ADIT_TRY(read_file(call.options.argument()));
  const auto checked = ADIT_TRY(ask_check(call.adit, settings));
  const auto& [errors, changes] = checked.row;
  if (!errors.empty() && !call.options.json) return Outcome{Exit::Attention, "", errors_text(errors)};
  return printed(call, checked.json, text_of(changes, call.console.colour),
                 errors.empty() ? Exit::Fine : Exit::Attention);
}

Result<Outcome> apply_settings(const Call& call) {
  const auto now = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  const auto settings = ADIT_TRY(read_file(call.options.argument()));
  return apply(call, now.row, settings);
}

Result<Outcome> set_setting(const Call& call) {
  const std::string key = call.options.argument(0), text = call.options.argument(1);
  const auto now = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  Value settings = now.row.settings;
  Value* const value = value_at(settings, key);
  if (value == nullptr) {
    const auto keys = keys_named(now.row, key);
    return keys ? failed("no such item of a list: " + key) : std::unexpected(keys.error());
  }
  *value = value_in(text, *value);
  return apply(call, now.row, settings);
}

Result<Outcome> export_settings(const Call& call) {
  const auto file = ADIT_TRY(get(call.adit, "/adit/settings/export"));
  return Outcome{Exit::Fine, file, ""};
}

Result<Outcome> course(const Call& call) {
  if (call.options.arguments.empty()) return list_courses(call);
  const std::string name = call.options.argument();
  const auto done = ADIT_TRY(change(call.adit, "/adit/course", {{"name", {name}}}, "adit course"));
  const std::string used = name.empty() ? "no course is in use: the endpoints are those of command_post"
                                        : "course " + name + " is in use";
  return printed(call, done.json, line(used) + warnings_text(done.row.warnings, call.console.colour));
}

}  // namespace adit::cli
