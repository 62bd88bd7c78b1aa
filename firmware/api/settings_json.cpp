#include "api/settings_json.hpp"

#include <utility>

#include "codec/json.hpp"
#include "codec/row.hpp"
#include "settings/keys.hpp"

namespace adit::api {
namespace {

using codec::json;
using codec::Value;

Value words_of(const settings::Choice& choice) {
  Value::Array words;
  for (const std::string_view word : choice.words) words.push_back({std::string(word)});
  return {std::move(words)};
}

/// What a form needs to know of each key.
Value keys_value() {
  const settings::Settings defaults = settings::with_an_item_of_each();
  Value::Array rows;
  for (const settings::Key& key : settings::keys()) {
    Value::Object row{{"path", {std::string(key.path)}},
                      {"meaning", {std::string(key.meaning)}},
                      {"kind", {std::string(settings::name_of(key.kind))}},
                      {"required", json(key.required)},
                      {"default", key.required ? Value{} : settings::value_of(key.kind, defaults)},
                      {"range", {settings::range_of(key.kind)}}};
    if (const auto* choice = std::get_if<settings::Choice>(&key.kind))
      row.emplace_back("words", words_of(*choice));
    if (const auto* whole = std::get_if<settings::Whole>(&key.kind)) {
      row.emplace_back("least", json(whole->least));
      row.emplace_back("most", json(whole->most));
    }
    if (const auto* real = std::get_if<settings::Real>(&key.kind)) {
      row.emplace_back("least", json(real->least));
      row.emplace_back("most", json(real->most));
    }
    rows.push_back({std::move(row)});
  }
  return {std::move(rows)};
}

Value value_of(const std::vector<settings::Change>& changes) {
  Value::Array rows;
  for (const settings::Change& change : changes) {
    rows.push_back({Value::Object{{"path", {change.path}}, {"from", change.from}, {"to", change.to}}});
  }
  return {std::move(rows)};
}

Value value_of(const std::vector<settings::Error>& errors) {
  Value::Array rows;
  for (const settings::Error& error : errors) {
    rows.push_back({Value::Object{{"path", {error.path}}, {"what", {error.what}}}});
  }
  return {std::move(rows)};
}

}  // namespace

std::string write_setup(const Setup& setup) {
  Value::Object tokens;
  for (const TokenRow& row : setup.tokens()) tokens.emplace_back(row.name, json(row.set));
  return codec::write_json({Value::Object{{"settings", settings::value_of(setup.settings())},
                                          {"tag", {settings::tag_of(setup.settings())}},
                                          {"saved", json(setup.saved())},
                                          {"applying", json(setup.applying())},
                                          {"trouble", {setup.trouble()}},
                                          {"tokens", {std::move(tokens)}},
                                          {"keys", keys_value()}}});
}

std::string write_check(const std::vector<settings::Error>& errors,
                        const std::vector<settings::Change>& changes,
                        const std::vector<std::string>& warnings) {
  return codec::write_json({Value::Object{
      {"errors", value_of(errors)}, {"changes", value_of(changes)}, {"warnings", json(warnings)}}});
}

std::string write_changes(const std::vector<settings::Change>& changes,
                          const std::vector<std::string>& warnings) {
  return codec::write_json({Value::Object{{"changes", value_of(changes)}, {"warnings", json(warnings)}}});
}

}  // namespace adit::api
