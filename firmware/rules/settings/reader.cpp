#include "settings/reader.hpp"

#include <algorithm>
#include <vector>

#include "codec/json.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"

namespace adit::settings {
namespace {

using codec::Value;

/// A member's name in a path: as it is if a plain word, else as a JSON string.
std::string shown_name(const std::string& name) {
  return is_word(name, 48) ? name : shown(Value{name});
}

/// "a list of 1 to 16 items"
std::string range_of(const List& list) {
  return list.least == 0 ? icd::sentence("a list of at most ", list.most, " items")
                         : icd::sentence("a list of ", list.least, " to ", list.most, " items");
}

}  // namespace

std::expected<Value, std::vector<Error>> read_json(std::string_view json) {
  auto root = codec::parse_json(json);
  if (!root) return std::unexpected(std::vector<Error>{{"", "not JSON: " + root.error()}});
  return *std::move(root);
}

std::string joined(const std::string& path, std::string_view name) {
  return path.empty() ? std::string(name) : path + "." + std::string(name);
}

void Reader::read_object(const Value& value, const std::string& pattern, const std::string& path) {
  const auto* members = std::get_if<Value::Object>(&value.is);
  if (members == nullptr) {
    errors.push_back({path, "expected an object, got " + shown(value)});
    return;
  }
  const auto children = children_of(pattern.empty() ? "" : pattern + ".");
  std::vector<std::string_view> seen;
  for (const auto& [name, member] : *members) {
    const auto child = std::ranges::find(children, name, &Child::name);
    if (child == children.end()) {
      tell_unknown(name, children, path);
    } else if (std::ranges::find(seen, child->name) != seen.end()) {
      errors.push_back({joined(path, name), "given twice"});
    } else {
      seen.push_back(child->name);
      read_child(*child, member, joined(pattern, name), joined(path, name));
    }
  }
  for (const Child& child : children) {
    if (std::ranges::find(seen, child.name) == seen.end()) {
      tell_missing(child, joined(pattern, child.name), joined(path, child.name));
    }
  }
}

void Reader::read_child(const Child& child, const Value& value, const std::string& pattern,
                        const std::string& path) {
  if (child.list) {
    read_list(value, pattern, path);
  } else if (child.key == nullptr) {
    read_object(value, pattern, path);
  } else if (const auto done = put(child.key->kind, value, settings); !done) {
    errors.push_back({path, done.error()});
  }
}

void Reader::read_list(const Value& value, const std::string& pattern, const std::string& path) {
  const List& list = list_at(pattern);
  const auto* items = std::get_if<Value::Array>(&value.is);
  if (items == nullptr || items->size() < list.least || items->size() > list.most) {
    const std::string got = items == nullptr ? shown(value) : std::to_string(items->size());
    errors.push_back({path, icd::sentence("expected ", range_of(list), ", got ", got)});
    return;
  }
  for (std::size_t i = 0; i < items->size(); ++i) {
    list.resize(settings, i + 1);
    read_object((*items)[i], pattern + "[]", icd::sentence(path, "[", i, "]"));
  }
}

void Reader::tell_unknown(const std::string& name, const std::vector<Child>& children,
                          const std::string& path) {
  if (passes_unknown) return passed_over.push_back(joined(path, shown_name(name)));
  std::vector<std::string_view> known;
  known.reserve(children.size());
  for (const Child& child : children) known.push_back(child.name);
  errors.push_back(
      {joined(path, shown_name(name)), icd::sentence("no such key", icd::did_you_mean(name, known),
                                                     " (keys here: ", icd::listed(known), ")")});
}

/// Names each required key at once, so that the user can write all of them.
void Reader::tell_missing(const Child& child, const std::string& pattern, const std::string& path) {
  if (child.list) {
    if (list_at(pattern).least > 0)
      errors.push_back({path, "missing; expected " + range_of(list_at(pattern))});
  } else if (child.key == nullptr) {
    read_object(Value{Value::Object{}}, pattern, path);
  } else if (child.key->required) {
    errors.push_back({path, "missing; expected " + range_of(child.key->kind)});
  }
}

}  // namespace adit::settings
