#include "codec/patch.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace adit::codec {
namespace {

std::optional<Value> change(const Row* row, const Value& before, const Value& now);

/// Objects of one row have their members in the same places.
const Value* member_of(const Value::Object& object, std::string_view name, std::size_t likely) {
  if (likely < object.size() && object[likely].first == name) return &object[likely].second;
  const auto found = std::ranges::find(object, name, &Value::Member::first);
  return found == object.end() ? nullptr : &found->second;
}

/// What a member is of that is a row, or a list of them.
const Row* row_of(const Schema& schema) {
  return schema.items != nullptr ? schema.items->row : schema.row;
}

const Row* row_in(const Row* row, std::string_view name, std::size_t likely) {
  if (row == nullptr) return nullptr;
  if (likely < row->members.size() && row->members[likely].name == name) {
    return row_of(*row->members[likely].kind->schema);
  }
  const auto found = std::ranges::find(row->members, name, &Member::name);
  return found == row->members.end() ? nullptr : row_of(*found->kind->schema);
}

std::optional<Value> change(const Row* row, const Value::Object& before, const Value::Object& now) {
  Value::Object changes;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto& [name, value] = now[i];
    const Value* const was = member_of(before, name, i);
    auto changed = was == nullptr ? std::optional(value) : change(row_in(row, name, i), *was, value);
    if (changed) changes.emplace_back(name, std::move(*changed));
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (member_of(now, before[i].first, i) == nullptr) changes.emplace_back(before[i].first, Value{});
  }
  if (changes.empty()) return std::nullopt;
  return Value{std::move(changes)};
}

/// Which row of a list came from which place of the one before; `from` has nothing for a new one.
struct Places {
  std::vector<std::optional<std::size_t>> from;
  bool moved = false;  // any of them
};

bool is_same_row(const Row& row, const Value& one, const Value& other) {
  const auto* const a = std::get_if<Value::Object>(&one.is);
  const auto* const b = std::get_if<Value::Object>(&other.is);
  return a != nullptr && b != nullptr && std::ranges::all_of(row.id, [&](std::string_view name) {
           const Value* const value = member_of(*a, name, 0);
           const Value* const same = member_of(*b, name, 0);
           return value != nullptr && same != nullptr && *value == *same;
         });
}

/// Rows mostly keep their order: that of one is looked for from behind that of the one before.
std::optional<std::size_t> place_of(const Row& row, const Value& one, const Value::Array& before,
                                    std::size_t likely) {
  for (std::size_t tried = 0; tried < before.size(); ++tried) {
    const std::size_t at = (likely + tried) % before.size();
    if (is_same_row(row, before[at], one)) return at;
  }
  return std::nullopt;
}

Places places_of(const Row& row, const Value::Array& before, const Value::Array& now) {
  Places places{.from = std::vector<std::optional<std::size_t>>(now.size())};
  if (row.id.empty()) return places;
  std::size_t likely = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto from = places.from[i] = place_of(row, now[i], before, likely);
    if (!from) continue;
    likely = *from + 1;
    places.moved |= *from != i;
  }
  return places;
}

/// As runs of neighbours.
Value::Array kept(const Places& places) {
  const auto& from = places.from;
  Value::Array runs;
  for (std::size_t to = 0, count = 0; to < from.size(); to += count) {
    count = 1;
    if (!from[to]) continue;
    while (to + count < from.size() && from[to + count] == *from[to] + count) ++count;
    Value::Array run;
    for (const std::size_t number : {to, *from[to], count}) run.push_back({std::uint64_t{number}});
    runs.push_back({std::move(run)});
  }
  return runs;
}

std::optional<Value> list_change(const Row& row, const Value::Array& before, const Value::Array& now) {
  const Places places = places_of(row, before, now);
  Value::Object list, rows;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto from = places.moved ? places.from[i] : i < before.size() ? std::optional(i) : std::nullopt;
    auto changed = from ? change(&row, before[*from], now[i]) : std::optional(now[i]);
    if (changed) rows.emplace_back(std::to_string(i), std::move(*changed));
  }
  if (now.size() != before.size()) list.emplace_back("length", Value{std::uint64_t{now.size()}});
  if (places.moved) list.emplace_back("kept", Value{kept(places)});
  if (!rows.empty()) list.emplace_back("rows", Value{std::move(rows)});
  if (list.empty()) return std::nullopt;
  return Value{std::move(list)};
}

/// `row`: of what they are, or of the rows that they list; or null.
std::optional<Value> change(const Row* row, const Value& before, const Value& now) {
  const auto* const object = std::get_if<Value::Object>(&now.is);
  const auto* const object_before = std::get_if<Value::Object>(&before.is);
  if (object != nullptr && object_before != nullptr) return change(row, *object_before, *object);
  const auto* const list = std::get_if<Value::Array>(&now.is);
  const auto* const list_before = std::get_if<Value::Array>(&before.is);
  if (row != nullptr && list != nullptr && list_before != nullptr)
    return list_change(*row, *list_before, *list);
  if (before == now) return std::nullopt;
  return now;
}

}  // namespace

std::optional<Value> patch(const Row& row, const Value& before, const Value& now) {
  return change(&row, before, now);
}

}  // namespace adit::codec
