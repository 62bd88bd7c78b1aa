#include "settings/settings.hpp"

#include <algorithm>
#include <string_view>

#include "icd/require.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "settings/reader.hpp"
#include "settings/written.hpp"

namespace adit::settings {
namespace {

using codec::Value;

/// If the file has another version, other errors mean little.
bool is_version_error(const std::vector<Error>& errors, const Value& root) {
  const auto* members = std::get_if<Value::Object>(&root.is);
  const auto is_version = [](const std::string& name) { return name == "version"; };
  return members != nullptr && std::ranges::any_of(*members, is_version, &Value::Member::first) &&
         std::ranges::any_of(errors, is_version, &Error::path);
}

std::expected<Settings, std::vector<Error>> read(Reader& reader, const Value& root) {
  Settings settings;
  reader.read_object(root, Settings::kRow, &settings, "");
  if (is_version_error(reader.errors, root)) {
    std::erase_if(reader.errors, [](const Error& error) { return error.path != "version"; });
  }
  if (reader.errors.empty()) reader.errors = contradictions(settings);
  if (!reader.errors.empty()) return std::unexpected(std::move(reader.errors));
  settings.without_effect = std::move(reader.without_effect);
  return settings;
}

}  // namespace

icd::RobotName name_of(const Robot& robot) {
  auto name = icd::RobotName::parse(robot.name);
  icd::require(name.has_value());
  return *std::move(name);
}

std::expected<Settings, std::vector<Error>> parse(std::string_view json) {
  const auto root = ADIT_TRY(read_json(json));
  return parse(root);
}

std::expected<Settings, std::vector<Error>> parse(const Value& root) {
  Reader reader;
  return read(reader, root);
}

std::expected<SavedSettings, std::vector<Error>> parse_saved(std::string_view json) {
  const auto root = ADIT_TRY(read_json(json));
  Reader reader;
  reader.passes_unknown = true;
  auto settings = ADIT_TRY(read(reader, root));
  return SavedSettings{std::move(settings), std::move(reader.passed_over)};
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> all;
  while (!text.empty()) {
    const std::string_view word = icd::cut(text, ' ');
    if (!word.empty()) all.push_back(word);
  }
  return all;
}

Settings effective_settings(Settings settings) {
  const auto course = std::ranges::find(settings.courses, settings.command_post.course, &Course::name);
  if (course != settings.courses.end()) {
    settings.command_post.scoring = course->scoring;
    settings.command_post.mapping = course->mapping;
  }
  for (const Robot& robot : settings.robots) {
    if (!robot.alias.empty()) settings.rules.aliases.emplace(robot.alias, name_of(robot));
  }
  return settings;
}

std::string sentence_of(const std::vector<Error>& errors) {
  std::string sentences;
  for (const Error& error : errors) sentences += (sentences.empty() ? "" : "; ") + error.sentence();
  return sentences;
}

namespace {

struct RestartRow {
  std::string_view begins;  // beginning of a setting's path
  Restarts restarts;
};

constexpr RestartRow kRows[] = {
    {"team.listen", {.listeners = true}},
    {"team.interface", {.listeners = true}},
    {"team.connections", {.listeners = true}},  // and team.connections_per_address
    {"command_post.scoring.", {.scoring = true}},
    {"command_post.mapping.", {.mapping = true}},
    {"command_post.interface", {.scoring = true, .mapping = true}},
    {"command_post.budget_mbit", {.mapping = true}},
    {"command_post.timeouts.connect_ms", {.scoring = true, .mapping = true}},
    {"command_post.timeouts.scoring_answer_ms", {.scoring = true}},
    {"command_post.timeouts.mapping_answer_ms", {.mapping = true}},
    {"panel.", {.panel = true}},
};

}  // namespace

Restarts restarts_by(const Settings& running, const Settings& next) {
  Restarts all;
  for (const Change& change : changes(running, next)) {
    for (const auto& [begins, restarts] : kRows) {
      if (!change.path.starts_with(begins)) continue;
      all.listeners = all.listeners || restarts.listeners;
      all.scoring = all.scoring || restarts.scoring;
      all.mapping = all.mapping || restarts.mapping;
      all.panel = all.panel || restarts.panel;
    }
  }
  return all;
}

}  // namespace adit::settings
