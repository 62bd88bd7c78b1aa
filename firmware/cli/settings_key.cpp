#include "cli/settings_key.hpp"

#include <algorithm>

#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "spelling/nearest.hpp"

namespace adit::cli {
namespace {

using codec::Value;

const Value* member_of(const Value& object, std::string_view name) {
  const auto* const members = std::get_if<Value::Object>(&object.is);
  if (members == nullptr) return nullptr;
  const auto found = std::ranges::find(*members, name, &Value::Member::first);
  return found == members->end() ? nullptr : &found->second;
}

std::string text_at(const Value& object, std::string_view name) {
  const Value* const value = member_of(object, name);
  const auto* const text = value == nullptr ? nullptr : std::get_if<std::string>(&value->is);
  return text == nullptr ? "" : *text;
}

bool begins(std::string_view path, std::string_view name) {
  return path.starts_with(name) && (path.size() == name.size() || path[name.size()] == '.' ||
                                    path[name.size()] == '[' || name.ends_with("[]"));
}

/// What stands at `pattern` ("robots[].alias") in `value`, which stands at `path`.
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

std::string allowed_of(const Value& key) {
  const Value* const required = member_of(key, "required");
  const auto* const is_required = required == nullptr ? nullptr : std::get_if<bool>(&required->is);
  const Value* const usual = member_of(key, "default");
  std::string text = "  may be " + host::escaped(text_at(key, "range"));
  if (is_required != nullptr && *is_required) return text + "; has to be there\n";
  return usual == nullptr ? text + "\n" : text + "; if not given: " + codec::write_json(*usual) + "\n";
}

}  // namespace

std::expected<std::vector<ShownKey>, std::string> keys_named(const Value& answer, const std::string& name) {
  const Value* const list = member_of(answer, "keys");
  const Value* const settings = member_of(answer, "settings");
  const auto* const all = list == nullptr ? nullptr : std::get_if<Value::Array>(&list->is);
  if (all == nullptr || settings == nullptr)
    return std::unexpected("Adit's answer cannot be understood: it names no keys");
  std::vector<ShownKey> found;
  std::vector<std::string> paths;
  for (const Value& key : *all) {
    paths.push_back(text_at(key, "path"));
    if (!begins(paths.back(), name)) continue;
    found.push_back({key, {}});
    put_values(*settings, paths.back(), "", found.back().values);
  }
  if (!found.empty()) return found;
  const std::vector<std::string_view> known(paths.begin(), paths.end());
  return std::unexpected("no such key of the settings: " + name + spelling::did_you_mean(name, known));
}

std::string text_of(const std::vector<ShownKey>& keys, bool colour) {
  std::string text;
  for (const ShownKey& key : keys) {
    Table values({{}, {}});
    for (const auto& [path, value] : key.values)
      values.add({{path, Tone::Strong}, {codec::write_json(value)}});
    if (key.values.empty()) values.add({{text_at(key.described, "path"), Tone::Strong}, {"none"}});
    text += (text.empty() ? "" : "\n") + values.written(colour) + "  " +
            host::escaped(text_at(key.described, "meaning")) + "\n" + allowed_of(key.described);
  }
  return text;
}

Value json_of(const std::vector<ShownKey>& keys) {
  Value::Array list;
  for (const ShownKey& key : keys) {
    Value row = key.described;
    if (auto* const members = std::get_if<Value::Object>(&row.is))
      members->emplace_back("values", Value{key.values});
    list.push_back(std::move(row));
  }
  return {list};
}

}  // namespace adit::cli
