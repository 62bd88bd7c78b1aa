#include "cli/settings.hpp"

#include <algorithm>
#include <chrono>

#include "api/settings_rows.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

using codec::Value;

template <class SomeValue>  // const or not
SomeValue* member_of(SomeValue& object, std::string_view name) {
  auto* const members = std::get_if<Value::Object>(&object.is);
  return members == nullptr ? nullptr : codec::find_member(*members, name);
}

std::string text_at(const Value& object, std::string_view name) {
  const Value* const value = member_of(object, name);
  const auto* const text = value == nullptr ? nullptr : std::get_if<std::string>(&value->is);
  return text == nullptr ? "" : *text;
}

/// The item with that index or name, or null.
Value* item_of(Value& list, std::string_view which) {
  auto* const items = std::get_if<Value::Array>(&list.is);
  if (items == nullptr) return nullptr;
  const auto index = icd::number_in<std::size_t>(which);
  const auto found = std::ranges::find_if(*items, [&](const Value& item) {
    return index ? &item == items->data() + *index : text_at(item, "name") == which;
  });
  return found == items->end() ? nullptr : &*found;
}

bool has_prefix(std::string_view path, std::string_view name) {
  return path.starts_with(name) && (path.size() == name.size() || path[name.size()] == '.' ||
                                    path[name.size()] == '[' || name.ends_with("[]"));
}

/// Adds the values at `pattern` ("robots[].alias") in `value`, whose own path is `path`.
void put_values(const Value& value, std::string_view pattern, const std::string& path, Value::Object& into) {
  if (pattern.empty()) return into.emplace_back(path, value), void();
  if (pattern.starts_with("[]")) {
    const auto* const items = std::get_if<Value::Array>(&value.is);
    for (std::size_t i = 0; items != nullptr && i < items->size(); ++i)
      put_values((*items)[i], pattern.substr(2), icd::sentence(path, "[", i, "]"), into);
    return;
  }
  if (pattern.starts_with('.')) pattern.remove_prefix(1);
  const std::string_view name = pattern.substr(0, pattern.find_first_of(".["));
  const Value* const next = member_of(value, name);
  if (next != nullptr)
    put_values(*next, pattern.substr(name.size()), icd::sentence(path, path.empty() ? "" : ".", name), into);
}

std::string allowed_of(const api::KeyRow& key) {
  return line("  allowed: ", key.range,
              key.required ? "; required" : "; default: " + plain(key.default_value));
}

/// "ugv1, ugv2": the names of a list's items, or "0 to 1".
std::string items_text(const Value& list) {
  const auto* const items = std::get_if<Value::Array>(&list.is);
  if (items == nullptr || items->empty()) return "it is empty";
  const std::string names = icd::join_words(*items, [](const Value& item) { return text_at(item, "name"); });
  return "there are " + (names.empty() ? icd::sentence("0 to ", items->size() - 1) : names);
}

/// "robots[ugv1].alias" as "robots[].alias"
std::string strip_items(std::string_view path) {
  std::string key;
  while (!path.empty()) {
    const std::size_t open = std::min(path.find('['), path.size() - 1);
    key += path.substr(0, open + 1);
    path.remove_prefix(path[open] == '[' ? std::min(path.find(']', open), path.size()) : path.size());
  }
  return key;
}

/// "robots has no item ugv9: there are ugv1, ugv2", or std::nullopt if each list of the path has its item.
std::optional<std::string> missing_item(Value& settings, const std::string& path) {
  for (std::size_t end = path.find(']'); end != std::string::npos; end = path.find(']', end + 1)) {
    const std::string item = path.substr(0, end + 1), list = item.substr(0, item.rfind('['));
    const Value* const all = value_at(settings, list);
    if (all == nullptr || value_at(settings, item) != nullptr) continue;
    return icd::sentence(list, " has no item ", item.substr(list.size() + 1, item.size() - list.size() - 2),
                         ": ", items_text(*all));
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<ShownKey>> keys_named(const api::SetupView& setup, const std::string& name) {
  Value settings = setup.settings;
  const std::string pattern = strip_items(name);
  const bool has_item = pattern != name;
  if (const auto missing = has_item ? missing_item(settings, name) : std::nullopt)
    return to_failure(*missing);
  std::vector<ShownKey> found;
  std::vector<std::string_view> known;
  for (const api::KeyRow& key : setup.keys) {
    known.push_back(key.path);
    if (!has_prefix(key.path, pattern)) continue;
    found.push_back({key, {}});
    if (!has_item) {
      put_values(settings, key.path, "", found.back().values);
    } else if (const std::string path = name + key.path.substr(pattern.size());
               const Value* const value = value_at(settings, path)) {
      found.back().values.emplace_back(path, *value);
    }
  }
  if (!found.empty()) return found;
  return to_failure("no such settings key: " + name + icd::did_you_mean(pattern, known));
}

Value* value_at(Value& settings, std::string_view path) {
  Value* value = &settings;
  while (value != nullptr && !path.empty()) {
    const std::size_t end = std::min(path.find_first_of(".[]"), path.size());
    const std::string_view name = path.substr(0, end);
    const bool is_item = path.substr(end).starts_with(']');
    if (!name.empty()) value = is_item ? item_of(*value, name) : member_of(*value, name);
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return value == &settings ? nullptr : value;
}

std::string plain(const Value& value) {
  if (std::holds_alternative<std::nullptr_t>(value.is)) return "(none)";
  const auto* const text = std::get_if<std::string>(&value.is);
  if (text == nullptr) return codec::write_json(value);
  return text->empty() ? "(empty)" : *text;
}

std::string text_of(const std::vector<ShownKey>& keys, bool colour) {
  std::string text;
  for (const ShownKey& key : keys) {
    Table values({{}, {}});
    for (const auto& [path, value] : key.values) values.add({{path, Tone::Strong}, {plain(value)}});
    if (key.values.empty()) values.add({{key.described.path, Tone::Strong}, {"(none)"}});
    text += (text.empty() ? "" : "\n") + values.to_text(colour) + line("  ", key.described.meaning) +
            allowed_of(key.described);
  }
  return text;
}

Value json_of(const std::vector<ShownKey>& keys) {
  Value::Array list;
  for (const ShownKey& key : keys) {
    Value row = codec::json(key.described);
    if (auto* const members = std::get_if<Value::Object>(&row.is))
      members->emplace_back("values", Value{key.values});
    list.push_back(std::move(row));
  }
  return {list};
}

namespace {

constexpr const char* kSettings = "/adit/settings";
constexpr const char* kSee = "adit settings";
constexpr PollPolicy kApplied{
    .within = std::chrono::seconds(5), .every = std::chrono::milliseconds(100), .may_be_away = true};

std::string warnings_text(const std::vector<std::string>& warnings, bool colour) {
  std::string text;
  for (const std::string& warning : warnings)
    text += paint("warning", Tone::Warning, colour) + ": " + line(warning);
  return text;
}

/// "  team.listen[0].port  8000 -> 8080"
std::string text_of(const api::ChangesView& view, bool colour) {
  Table table({{}, {}, {}});
  for (const settings::Change& change : view.changes)
    table.add({{change.path, Tone::Strong}, {plain(change.from)}, {"-> " + plain(change.to)}});
  return (table.empty() ? "no changes\n" : table.to_text(colour)) + warnings_text(view.warnings, colour);
}

std::string errors_text(const std::vector<settings::Error>& errors) {
  std::string text;
  for (const settings::Error& error : errors) text += line("adit: ", error.sentence());
  return text;
}

/// A settings file; Adit checks its settings.
struct SettingsFile {
  std::string text;
  Value settings;
};

Result<SettingsFile> read_file(const std::string& file) {
  auto text = host::read_file(file);
  if (!text) return to_failure(text.error());
  auto value = codec::parse_json(*text);
  if (value) return SettingsFile{*std::move(text), *std::move(value)};
  std::vector<settings::Error> errors{{"", value.error()}};
  settings::find_places(*text, errors);
  return to_failure(file + ": " + errors.front().sentence());
}

std::string text_of(const api::SetupView& setup, const settings::Settings& settings, bool colour) {
  Table table({{}, {}});
  for (const settings::Change& change : settings::changes({}, settings))
    table.add({{change.path, Tone::Strong}, {plain(change.to)}});
  return (setup.saved ? "saved on this box\n" : "as installed\n") + table.to_text(colour) +
         "all others have their defaults\n\ntokens\n" + tokens_text(setup.tokens, colour);
}

Result<Fetched<api::CheckView>> ask_check(const Adit& adit, const Value& settings) {
  return read_row_of<api::CheckView>(
      adit, post(adit, {.target = "/adit/settings/check",
                        .check = kSee,
                        .body = codec::write_json({Value::Object{{"settings", settings}}})}));
}

/// Posts a change and waits until the box uses it. Error: the box reverted it, or does not use it in time.
Result<Fetched<api::ChangesView>> change(const Adit& adit, const std::string& target,
                                         const Value::Object& body, const char* check) {
  auto changed = read_row_of<api::ChangesView>(
      adit, post(adit, {.target = target, .check = check, .body = codec::write_json({body})}));
  if (!changed || changed->row.changes.empty()) return changed;  // `trouble` may be older
  const auto now = fetch_until<api::SetupView>(adit, kSettings, kApplied,
                                               [](const api::SetupView& setup) { return !setup.applying; });
  if (!now) {
    const std::string& why = now.error().sentence;
    return to_failure("the change was accepted, but is not seen in use" +
                      (why.empty() ? "" : "; at its new address? " + why));
  }
  if (now->row.trouble.empty()) return changed;
  return to_failure(now->row.trouble, Exit::Attention);
}

/// VALUE of the command line: JSON, or a text without quotes. `before`: the present value.
Value value_in(const std::string& text, const Value& before) {
  auto value = codec::parse_json(text);
  const auto is_text = [](const Value& any) { return std::holds_alternative<std::string>(any.is); };
  return value && (!is_text(before) || is_text(*value)) ? *std::move(value) : Value{text};
}

/// Checks the settings and applies them to a box with the settings of `now`. `text`: their file's, or "".
Result<Outcome> apply(const Call& call, const api::SetupView& now, const Value& settings,
                      std::string_view text = "") {
  auto checked = ADIT_TRY(ask_check(call.adit, settings));
  if (auto& errors = checked.row.errors; !errors.empty()) {
    if (!text.empty()) settings::find_places(text, errors);
    return Outcome{Exit::Attention, "", errors_text(errors)};
  }
  const auto done =
      ADIT_TRY(change(call.adit, kSettings, {{"settings", settings}, {"base", {now.tag}}}, kSee));
  return print_result(call, done.json, text_of(checked.row.changes, call.console.colour));
}

/// "" stands for the endpoints of command_post.
std::string courses_text(const settings::Settings& settings, bool colour) {
  const settings::CommandPost& post = settings.command_post;
  Table table({{"course"}, {"scoring"}, {"mapping"}, {""}});
  std::vector<settings::Course> courses = settings.courses;
  courses.push_back({.name = "", .scoring = post.scoring, .mapping = post.mapping});
  for (const settings::Course& each : courses) {
    table.add({{each.name.empty() ? "\"\"" : each.name, Tone::Strong},
               {to_text(each.scoring)},
               {to_text(each.mapping)},
               {each.name == post.course ? "in use" : "", Tone::Good}});
  }
  return table.to_text(colour);
}

Result<Outcome> list_courses(const Call& call) {
  const auto setup = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  const auto settings = ADIT_TRY(settings_in(setup.row));
  Value all = setup.row.settings;
  const Value* const courses = value_at(all, "courses");
  const Value::Object listed{{"course", {settings.command_post.course}},
                             {"courses", courses == nullptr ? Value{} : *courses}};
  return print_result(call, codec::write_json({listed}), courses_text(settings, call.console.colour));
}

}  // namespace

Result<settings::Settings> settings_in(const api::SetupView& setup) {
  auto settings = settings::parse(setup.settings);
  if (!settings) return to_failure("cannot read Adit's answer: " + settings::sentence_of(settings.error()));
  return *std::move(settings);
}

Result<Outcome> show_settings(const Call& call) {
  const bool colour = call.console.colour;
  const auto setup = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  if (const std::string key = call.options.argument(); !key.empty()) {
    const auto keys = ADIT_TRY(keys_named(setup.row, key));
    return print_result(call, codec::write_json(json_of(keys)), text_of(keys, colour));
  }
  const auto settings = ADIT_TRY(settings_in(setup.row));
  return print_result(call, setup.json, text_of(setup.row, settings, colour));
}

Result<Outcome> check_settings(const Call& call) {
  const auto file = ADIT_TRY(read_file(call.options.argument()));
  auto checked = ADIT_TRY(ask_check(call.adit, file.settings));
  auto& [errors, changes] = checked.row;
  settings::find_places(file.text, errors);
  if (!errors.empty() && !call.options.json) return Outcome{Exit::Attention, "", errors_text(errors)};
  return print_result(call, checked.json, text_of(changes, call.console.colour),
                      errors.empty() ? Exit::Fine : Exit::Attention);
}

Result<Outcome> apply_settings(const Call& call) {
  const auto now = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  const auto file = ADIT_TRY(read_file(call.options.argument()));
  return apply(call, now.row, file.settings, file.text);
}

Result<Outcome> set_setting(const Call& call) {
  const std::string key = call.options.argument(0), text = call.options.argument(1);
  const auto now = ADIT_TRY(fetch<api::SetupView>(call.adit, kSettings));
  Value settings = now.row.settings;
  Value* const value = value_at(settings, key);
  if (value == nullptr) {
    ADIT_TRY(keys_named(now.row, key));
    return to_failure("no such item of a list: " + key);
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
  return print_result(call, done.json, line(used) + warnings_text(done.row.warnings, call.console.colour));
}

}  // namespace adit::cli
