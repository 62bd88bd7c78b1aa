#include "settings/written.hpp"

#include <algorithm>
#include <cstdint>

#include "codec/json.hpp"
#include "codec/row.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::settings {
namespace {

using codec::Value;

bool is_nested(const Value& value) {
  return std::holds_alternative<Value::Object>(value.is) || std::holds_alternative<Value::Array>(value.is);
}

bool is_short(const Value& value) {
  constexpr std::size_t kLine = 80;
  const auto* const members = std::get_if<Value::Object>(&value.is);
  const auto* const items = std::get_if<Value::Array>(&value.is);
  if (members == nullptr && items == nullptr) return true;
  const bool flat = members != nullptr ? std::ranges::none_of(*members, is_nested, &Value::Member::second)
                                       : std::ranges::none_of(*items, is_nested);
  return flat && codec::write_json(value).size() <= kLine;
}

/// Writes an object or a list with its parts on separate lines, unless it is short.
void write(const Value& value, const std::string& indent, std::string& text) {
  if (is_short(value)) {
    text += codec::write_json(value);
    return;
  }
  const std::string inner = indent + "  ";
  const auto* const members = std::get_if<Value::Object>(&value.is);
  std::string_view before = "\n";
  const auto begin_part = [&] {
    text.append(before).append(inner);
    before = ",\n";
  };
  text += members != nullptr ? '{' : '[';
  if (members != nullptr) {
    for (const auto& [name, member] : *members) {
      begin_part();
      text.append(codec::write_json({name})).append(": ");
      write(member, inner, text);
    }
  } else {
    for (const Value& item : std::get<Value::Array>(value.is)) {
      begin_part();
      write(item, inner, text);
    }
  }
  text.append("\n").append(indent) += members != nullptr ? '}' : ']';
}

/// An item's name, or its index.
std::string name_in(const Value& item, std::size_t index) {
  const Value* const name = codec::find_member(std::get<Value::Object>(item.is), "name");
  return name == nullptr ? std::to_string(index) : std::get<std::string>(name->is);
}

using Leaves = std::vector<std::pair<std::string, Value>>;

/// All scalar values with their paths.
void flatten(const Value& value, const std::string& path, Leaves& leaves) {
  if (const auto* members = std::get_if<Value::Object>(&value.is)) {
    for (const auto& [name, member] : *members) {
      flatten(member, path.empty() ? name : icd::sentence(path, ".", name), leaves);
    }
  } else if (const auto* items = std::get_if<Value::Array>(&value.is)) {
    for (std::size_t i = 0; i < items->size(); ++i) {
      flatten((*items)[i], icd::sentence(path, "[", name_in((*items)[i], i), "]"), leaves);
    }
  } else {
    leaves.emplace_back(path, value);
  }
}

Leaves leaves_of(const Settings& settings) {
  Leaves leaves;
  flatten(value_of(settings), "", leaves);
  return leaves;
}

}  // namespace

Value value_of(const Settings& settings) {
  return codec::json(settings);
}

std::string file_of(const Settings& settings) {
  std::string text;
  write(value_of(settings), "", text);
  return text + '\n';
}

std::string tag_of(const Settings& settings) {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const char letter : codec::write_json(value_of(settings))) {
    hash = (hash ^ static_cast<std::uint8_t>(letter)) * 0x100000001b3;
  }
  std::string tag;
  for (int shift = 56; shift >= 0; shift -= 8) tag += icd::hex(static_cast<std::uint8_t>(hash >> shift));
  return tag;
}

std::vector<Change> changes(const Settings& from, const Settings& to) {
  const Leaves before = leaves_of(from), after = leaves_of(to);
  const auto at = [](const Leaves& leaves, const std::string& path) {
    const auto found = std::ranges::find(leaves, path, &Leaves::value_type::first);
    return found == leaves.end() ? Value{} : found->second;
  };
  std::vector<Change> changes;
  for (const auto& [path, value] : before) {
    Value now = at(after, path);
    if (codec::write_json(value) != codec::write_json(now)) changes.push_back({path, value, std::move(now)});
  }
  for (const auto& [path, value] : after) {
    if (std::ranges::find(before, path, &Leaves::value_type::first) == before.end()) {
      changes.push_back({path, {}, value});
    }
  }
  return changes;
}

std::vector<std::string> token_names(const Settings& settings) {
  std::vector<std::string> names = {"scoring", "mapping", "team"};
  for (const Course& course : settings.courses) {
    names.push_back("course." + course.name + ".scoring");
    names.push_back("course." + course.name + ".mapping");
  }
  return names;
}

}  // namespace adit::settings
