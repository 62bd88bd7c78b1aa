#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <string_view>

#include "codec/json.hpp"
#include "project_files.hpp"
#include "settings/keys.hpp"
#include "settings/settings.hpp"

namespace adit::settings {
namespace {

std::string text_of(const std::string& file) {
  return project_text("firmware/rules/settings/" + file);
}

TEST(SettingsReadme, ShowsAnExampleThatWorks) {
  const std::string text = text_of("README.md");
  const auto begin = text.find("```json\n") + 8;
  ASSERT_TRUE(parse(text.substr(begin, text.find("```", begin) - begin)).has_value());
}

TEST(SettingsExample, Works) {
  const auto settings = parse(text_of("example.json"));
  ASSERT_TRUE(settings.has_value()) << settings.error().front().sentence();
  EXPECT_EQ(settings->command_post.interface, "darpa0");
}

/// {"robots": [{"alias": ""}]} for "robots[].alias".
codec::Value nested(std::string_view path, codec::Value value) {
  const auto dot = path.rfind('.');
  const bool last = dot == std::string_view::npos;
  std::string name(last ? path : path.substr(dot + 1));
  if (name.ends_with("[]")) {
    name.resize(name.size() - 2);
    value = codec::Value{codec::Value::Array{std::move(value)}};
  }
  codec::Value object{codec::Value::Object{{std::move(name), std::move(value)}}};
  return last ? object : nested(path.substr(0, dot), std::move(object));
}

TEST(SettingsKeys, AcceptTheirDefaults) {
  for (const Key& key : keys()) {
    if (key.required) continue;
    const auto value = codec::parse_json(codec::write_json(key.default_value));
    ASSERT_TRUE(value.has_value()) << key.path;
    const auto settings = parse(codec::write_json(nested(key.path, *value)));
    ASSERT_FALSE(settings.has_value());  // version and addresses are missing
    const std::string item = std::regex_replace(std::string(key.path), std::regex("\\[\\]"), "[0]");
    for (const Error& error : settings.error()) EXPECT_NE(error.path, item) << error.sentence();
  }
}

}  // namespace
}  // namespace adit::settings
