#include "cli/settings.hpp"

#include <chrono>

#include "cli/ask.hpp"
#include "cli/reading.hpp"
#include "cli/settings_key.hpp"
#include "cli/table.hpp"
#include "cli/where.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "settings/written.hpp"

namespace adit::cli {
namespace {

using codec::Value;

constexpr const char* kSee = "adit settings";
constexpr std::chrono::milliseconds kApplied{5000}, kLookAgain{100};

/// A member of an answer that has been read; null where it is not there.
Value member(const Value& object, std::string_view name) {
  if (const auto* members = std::get_if<Value::Object>(&object.is)) {
    for (const auto& [each, value] : *members) {
      if (each == name) return value;
    }
  }
  return {};
}

std::vector<Value> items(const Value& object, std::string_view name) {
  const Value list = member(object, name);
  const auto* const array = std::get_if<Value::Array>(&list.is);
  return array == nullptr ? std::vector<Value>() : *array;
}

std::string text_of(const Value& value) {
  const auto* const text = std::get_if<std::string>(&value.is);
  return text == nullptr ? "" : *text;
}

bool truth_of(const Value& value) {
  const auto* const truth = std::get_if<bool>(&value.is);
  return truth != nullptr && *truth;
}

Outcome not_understood(const std::string& why) {
  return unable("cannot read Adit's answer: " + why);
}

/// "  team.listen[0].port  8000 -> 8080"
std::string changed_text(const Value& answer, bool colour) {
  Table table({{}, {}, {}});
  for (const Value& change : items(answer, "changes")) {
    table.add({{text_of(member(change, "path")), Tone::Strong},
               {plain(member(change, "from"))},
               {"-> " + plain(member(change, "to"))}});
  }
  return table.empty() ? "no changes\n" : table.written(colour);
}

std::string warnings_text(const Value& answer, bool colour) {
  std::string text;
  for (const Value& warning : items(answer, "warnings")) {
    text += painted("warning", Tone::Warning, colour) + ": " + host::escaped(text_of(warning)) + '\n';
  }
  return text;
}

std::string errors_text(const Value& answer) {
  std::string text;
  for (const Value& error : items(answer, "errors")) {
    const std::string path = text_of(member(error, "path")), what = text_of(member(error, "what"));
    text += "adit: " + host::escaped(path.empty() ? what : path + ": " + what) + '\n';
  }
  return text;
}

/// The file's JSON. Adit checks the settings in it.
std::expected<Value, std::string> read_file(const std::string& file) {
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(text.error());
  auto value = codec::parse_json(*text);
  if (!value) return std::unexpected(file + ": not JSON: " + value.error());
  return std::move(*value);
}

Outcome show(const std::string& body, const Options& options, bool colour) {
  if (options.json) return {Exit::Fine, body + '\n', ""};
  const auto answer = codec::parse_json(body);
  if (!answer) return not_understood(answer.error());
  const auto settings = settings::parse(member(*answer, "settings"));
  if (!settings) return not_understood(settings::sentence_of(settings.error()));
  std::string text = truth_of(member(*answer, "saved")) ? "saved on this box\n" : "as installed\n";
  Table table({{}, {}});
  for (const settings::Change& change : settings::changes({}, *settings)) {
    table.add({{change.path, Tone::Strong}, {plain(change.to)}});
  }
  text += table.written(colour) + "all others have their defaults\n\ntokens\n";
  Table tokens({{}, {}});
  const Value set = member(*answer, "tokens");
  if (const auto* members = std::get_if<Value::Object>(&set.is)) {
    for (const auto& [name, value] : *members) {
      const bool there = truth_of(value);
      tokens.add({{name, Tone::Strong}, {there ? "set" : "not set", there ? Tone::Good : Tone::Warning}});
    }
  }
  return {Exit::Fine, text + tokens.written(colour), ""};
}

Outcome show_keys(const std::string& body, const Options& options, bool colour) {
  const auto answer = codec::parse_json(body);
  if (!answer) return not_understood(answer.error());
  const auto keys = keys_named(*answer, options.key);
  if (!keys) return unable(keys.error());
  return {Exit::Fine, options.json ? codec::write_json(json_of(*keys)) + '\n' : text_of(*keys, colour), ""};
}

/// Adit's check of settings.
struct Checked {
  Value settings, answer;
  std::string body;
  bool good() const { return items(answer, "errors").empty(); }
};

std::expected<Checked, Failure> ask_check(const Adit& adit, Value settings) {
  const std::string question = codec::write_json({Value::Object{{"settings", settings}}});
  auto body = post(adit, "/adit/settings/check", question, kSee);
  if (!body) return std::unexpected(body.error());
  auto answer = codec::parse_json(*body);
  if (!answer) return std::unexpected(Failure{Exit::Unable, "cannot read Adit's answer: " + answer.error()});
  return Checked{std::move(settings), std::move(*answer), std::move(*body)};
}

Outcome check(const Adit& adit, const Options& options, bool colour) {
  const auto settings = read_file(options.file);
  if (!settings) return unable(settings.error());
  const auto checked = ask_check(adit, *settings);
  if (!checked) return unable(checked.error());
  const Exit exit = checked->good() ? Exit::Fine : Exit::Attention;
  if (options.json) return {exit, checked->body + '\n', ""};
  if (!checked->good()) return {exit, "", errors_text(checked->answer)};
  return {exit, changed_text(checked->answer, colour) + warnings_text(checked->answer, colour), ""};
}

/// Waits until the box uses a change that it answered with `accepted`. Error: the box reverted the change, or
/// does not say within kApplied that it uses it.
std::expected<void, Failure> until_applied(const Adit& adit, const std::string& accepted) {
  const auto changed = codec::parse_json(accepted);
  if (changed && items(*changed, "changes").empty()) return {};  // `trouble` is of an earlier change
  std::expected<Value, std::string> answer = std::unexpected(std::string());
  const bool is_over = wait_for(kApplied, kLookAgain, [&] {
    const auto body = get(adit, "/adit/settings");
    answer = body ? codec::parse_json(*body) : std::unexpected(body.error());
    return answer && !truth_of(member(*answer, "applying"));
  });
  if (!is_over) {
    return std::unexpected(
        Failure{Exit::Unable, "the change was accepted, but is not seen in use" +
                                  (answer ? "" : "; at its new address? " + answer.error())});
  }
  const std::string trouble = text_of(member(*answer, "trouble"));
  if (trouble.empty()) return {};
  return std::unexpected(Failure{Exit::Attention, host::escaped(trouble)});
}

/// VALUE of the command line: JSON, or a text without quotes. `before`: the value that it replaces.
Value value_in(const std::string& text, const Value& before) {
  auto value = codec::parse_json(text);
  const auto is_text = [](const Value& any) { return std::holds_alternative<std::string>(any.is); };
  return value && (!is_text(before) || is_text(*value)) ? *std::move(value) : Value{text};
}

/// The settings of `now`, Adit's answer, with the change of `adit settings set`; or those of the file.
std::expected<Value, std::string> wanted(const Value& now, const Options& options) {
  if (options.verb == Verb::Apply) return read_file(options.file);
  Value settings = member(now, "settings");
  Value* const value = value_at(settings, options.key);
  if (value == nullptr) {
    const auto keys = keys_named(now, options.key);
    return std::unexpected(keys ? "no such item of a list: " + options.key : keys.error());
  }
  *value = value_in(options.value, *value);
  return settings;
}

Outcome apply(const Adit& adit, const Options& options, bool colour) {
  const auto body = get(adit, "/adit/settings");
  if (!body) return unable(body.error());
  const auto now = codec::parse_json(*body);
  if (!now) return not_understood(now.error());
  auto settings = wanted(*now, options);
  if (!settings) return unable(settings.error());
  const auto checked = ask_check(adit, *std::move(settings));
  if (!checked) return unable(checked.error());
  if (!checked->good()) return {Exit::Attention, "", errors_text(checked->answer)};
  const Value tag = member(*now, "tag");
  if (!std::holds_alternative<std::string>(tag.is)) return not_understood("tag: expected a text");
  const Value::Object changed{{"settings", checked->settings}, {"base", tag}};
  const auto done = post(adit, "/adit/settings", codec::write_json({changed}), kSee);
  if (!done) return unable(done.error());
  if (const auto applied = until_applied(adit, *done); !applied) return unable(applied.error());
  if (options.json) return {Exit::Fine, *done + '\n', ""};
  return {Exit::Fine, changed_text(checked->answer, colour) + warnings_text(checked->answer, colour), ""};
}

/// "" stands for the endpoints of command_post itself.
Outcome list_courses(const Adit& adit, const Options& options, bool colour) {
  const auto body = get(adit, "/adit/settings");
  if (!body) return unable(body.error());
  const auto answer = codec::parse_json(*body);
  if (!answer) return not_understood(answer.error());
  const Value all = member(*answer, "settings");
  const auto settings = settings::parse(all);
  if (!settings) return not_understood(settings::sentence_of(settings.error()));
  const settings::CommandPost& post = settings->command_post;
  if (options.json) {
    const Value::Object listed{{"course", {post.course}}, {"courses", member(all, "courses")}};
    return {Exit::Fine, codec::write_json({listed}) + '\n', ""};
  }
  Table table({{"course"}, {"scoring"}, {"mapping"}, {""}});
  std::vector<settings::Course> courses = settings->courses;
  courses.push_back({.name = "", .scoring = post.scoring, .mapping = post.mapping});
  for (const settings::Course& each : courses) {
    table.add({{each.name.empty() ? "\"\"" : each.name, Tone::Strong},
               {written(each.scoring)},
               {written(each.mapping)},
               {each.name == post.course ? "in use" : "", Tone::Good}});
  }
  return {Exit::Fine, table.written(colour), ""};
}

}  // namespace

Outcome settings(const Options& options, bool colour) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (options.verb == Verb::Check) return check(*adit, options, colour);
  if (options.verb == Verb::Apply || options.verb == Verb::Set) return apply(*adit, options, colour);
  const bool exports = options.verb == Verb::Export;
  const auto body = get(*adit, exports ? "/adit/settings/export" : "/adit/settings");
  if (!body) return unable(body.error());
  if (exports) return {Exit::Fine, *body, ""};
  return options.key.empty() ? show(*body, options, colour) : show_keys(*body, options, colour);
}

Outcome course(const Options& options, bool colour) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (!options.course) return list_courses(*adit, options, colour);
  const auto body = post(*adit, "/adit/course",
                         codec::write_json({Value::Object{{"name", {*options.course}}}}), "adit course");
  if (!body) return unable(body.error());
  if (const auto applied = until_applied(*adit, *body); !applied) return unable(applied.error());
  if (options.json) return {Exit::Fine, *body + '\n', ""};
  const auto answer = codec::parse_json(*body);
  if (!answer) return not_understood(answer.error());
  const std::string used = options.course->empty()
                               ? "no course is in use: the endpoints are those of command_post"
                               : "course " + *options.course + " is in use";
  return {Exit::Fine, used + '\n' + warnings_text(*answer, colour), ""};
}

}  // namespace adit::cli
