#include "cli/settings_key.hpp"

#include <algorithm>

#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"

namespace adit::cli {
namespace {

using codec::Value;

template <class SomeValue>  // const or not
SomeValue* member_of(SomeValue& object, std::string_view name) {
  auto* const members = std::get_if<Value::Object>(&object.is);
  if (members == nullptr) return nullptr;
  const auto found = std::ranges::find(*members, name, &Value::Member::first);
  return found == members->end() ? nullptr : &found->second;
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

bool begins(std::string_view path, std::string_view name) {
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

}  // namespace

Result<std::vector<ShownKey>> keys_named(const api::SetupView& setup, const std::string& name) {
  std::vector<ShownKey> found;
  std::vector<std::string_view> known;
  for (const api::KeyRow& key : setup.keys) {
    known.push_back(key.path);
    if (!begins(key.path, name)) continue;
    found.push_back({key, {}});
    put_values(setup.settings, key.path, "", found.back().values);
  }
  if (!found.empty()) return found;
  return failed("no such settings key: " + name + icd::did_you_mean(name, known));
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
    text += (text.empty() ? "" : "\n") + values.written(colour) + line("  ", key.described.meaning) +
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

}  // namespace adit::cli
