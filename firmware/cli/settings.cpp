#include "cli/settings.hpp"

#include "cli/ask.hpp"
#include "cli/reading.hpp"
#include "cli/settings_key.hpp"
#include "cli/table.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "settings/written.hpp"

namespace adit::cli {
namespace {

using codec::Field;
using codec::Value;

constexpr const char* kSee = "adit settings";

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
  return text == nullptr ? codec::write_json(value) : *text;
}

bool truth_of(const Value& value) {
  const auto* const truth = std::get_if<bool>(&value.is);
  return truth != nullptr && *truth;
}

Outcome not_understood(const std::string& why) {
  return unable("Adit's answer cannot be understood: " + why);
}

/// "  team.listen[0].port  8000 -> 8080"
std::string changed_text(const Value& answer, bool colour) {
  Table table({{}, {}, {}});
  for (const Value& change : items(answer, "changes")) {
    table.add({{text_of(member(change, "path")), Tone::Strong},
               {codec::write_json(member(change, "from"))},
               {"-> " + codec::write_json(member(change, "to"))}});
  }
  return table.empty() ? "nothing changes\n" : table.written(colour);
}

std::string warnings_text(const Value& answer, bool colour) {
  std::string text;
  for (const Value& warning : items(answer, "warnings")) {
    text += painted("mind", Tone::Warning, colour) + ": " + host::escaped(text_of(warning)) + '\n';
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

/// The file's JSON; whether it is good is for Adit to say.
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
  std::string text = truth_of(member(*answer, "saved")) ? "saved on the box\n" : "as the box was given\n";
  Table table({{}, {}});
  for (const settings::Change& change : settings::changes({}, *settings)) {
    table.add({{change.path, Tone::Strong}, {codec::write_json(change.to)}});
  }
  text += table.written(colour) + "all else is as by default\n\ntokens\n";
  Table tokens({{}, {}});
  const Value set = member(*answer, "tokens");
  if (const auto* members = std::get_if<Value::Object>(&set.is)) {
    for (const auto& [name, value] : *members) {
      const bool there = truth_of(value);
      tokens.add({{name, Tone::Strong}, {there ? "set" : "none", there ? Tone::Good : Tone::Warning}});
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

/// What Adit says of the settings in a file: whether it would take them.
struct Checked {
  Value settings, answer;
  std::string body;
  bool good() const { return items(answer, "errors").empty(); }
};

std::expected<Checked, Failure> ask_check(const Adit& adit, const std::string& file) {
  auto settings = read_file(file);
  if (!settings) return std::unexpected(Failure{Exit::Unable, settings.error()});
  const std::string question = codec::write_json({Value::Object{{"settings", *settings}}});
  auto body = post(adit, "/adit/settings/check", question, kSee);
  if (!body) return std::unexpected(body.error());
  auto answer = codec::parse_json(*body);
  if (!answer) return std::unexpected(Failure{Exit::Unable, "Adit's answer is no JSON: " + answer.error()});
  return Checked{std::move(*settings), std::move(*answer), std::move(*body)};
}

Outcome check(const Adit& adit, const Options& options, bool colour) {
  const auto checked = ask_check(adit, options.file);
  if (!checked) return unable(checked.error());
  const Exit exit = checked->good() ? Exit::Fine : Exit::Attention;
  if (options.json) return {exit, checked->body + '\n', ""};
  if (!checked->good()) return {exit, "", errors_text(checked->answer)};
  return {exit, changed_text(checked->answer, colour) + warnings_text(checked->answer, colour), ""};
}

Outcome apply(const Adit& adit, const Options& options, bool colour) {
  const auto before = get(adit, "/adit/settings");
  if (!before) return unable(before.error());
  const auto tag = read<std::string>(*before, [](const Field& object) { return text(object, "tag"); });
  if (!tag) return not_understood(tag.error());
  const auto checked = ask_check(adit, options.file);
  if (!checked) return unable(checked.error());
  if (!checked->good()) return {Exit::Attention, "", errors_text(checked->answer)};
  const auto done =
      post(adit, "/adit/settings",
           codec::write_json({Value::Object{{"settings", checked->settings}, {"base", {*tag}}}}), kSee);
  if (!done) return unable(done.error());
  if (options.json) return {Exit::Fine, *done + '\n', ""};
  return {Exit::Fine, changed_text(checked->answer, colour) + warnings_text(checked->answer, colour), ""};
}

}  // namespace

Outcome settings(const Options& options, bool colour) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (options.verb == Verb::Check) return check(*adit, options, colour);
  if (options.verb == Verb::Apply) return apply(*adit, options, colour);
  const bool exports = options.verb == Verb::Export;
  const auto body = get(*adit, exports ? "/adit/settings/export" : "/adit/settings");
  if (!body) return unable(body.error());
  if (exports) return {Exit::Fine, *body, ""};
  return options.key.empty() ? show(*body, options, colour) : show_keys(*body, options, colour);
}

Outcome switch_course(const Options& options, bool colour) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  const auto body =
      post(*adit, "/adit/course", codec::write_json({Value::Object{{"name", {options.course}}}}), kSee);
  if (!body) return unable(body.error());
  if (options.json) return {Exit::Fine, *body + '\n', ""};
  const auto answer = codec::parse_json(*body);
  if (!answer) return not_understood(answer.error());
  const std::string used =
      options.course.empty() ? "no course is in use" : "course " + options.course + " is in use";
  return {Exit::Fine, used + '\n' + warnings_text(*answer, colour), ""};
}

}  // namespace adit::cli
