#include "settings/reader.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "icd/sentence.hpp"

namespace adit::settings {
namespace {

using codec::Value;

/// A member's name for a path: as it is, or as a JSON string where it is no plain word.
std::string shown_name(const std::string& name) {
  const bool plain = !name.empty() && name.size() <= 48 && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return plain ? name : shown(Value{name});
}

/// "a list of 1 to 16 items"
std::string range_of(const List& list) {
  return list.least == 0 ? icd::sentence("a list of at most ", list.most, " items")
                         : icd::sentence("a list of ", list.least, " to ", list.most, " items");
}

/// Letters to insert, leave out or replace (Levenshtein).
std::size_t distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t replaced = diagonal + (from[i - 1] == to[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

bool one_begins_the_other(std::string_view a, std::string_view b) {
  static constexpr std::size_t kTelling = 3;
  if (std::min(a.size(), b.size()) < kTelling) return false;
  return a.starts_with(b) || b.starts_with(a);
}

/// The one of `known` that `name` was likely meant to be: a few letters differ, or one begins with the other.
std::optional<std::string_view> nearest(std::string_view name, std::span<const std::string_view> known) {
  static constexpr std::size_t kLongest = 64;  // no key is that long, and a hostile one costs nothing
  if (name.size() > kLongest) return std::nullopt;
  std::optional<std::string_view> best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    const std::size_t apart = one_begins_the_other(name, candidate) ? 1 : distance(name, candidate);
    if (apart < least && apart < candidate.size()) {
      least = apart;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

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
  std::string list;
  for (const Child& child : children) {
    known.push_back(child.name);
    list.append(list.empty() ? "" : ", ").append(child.name);
  }
  std::string what = "no such key";
  if (const auto meant = nearest(name, known)) what.append("; did you mean ").append(*meant).append("?");
  errors.push_back({joined(path, shown_name(name)), what + " (keys here: " + list + ")"});
}

/// Names each required key, so that one look tells all that is to be written.
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
