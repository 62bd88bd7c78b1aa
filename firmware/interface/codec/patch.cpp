#include "codec/patch.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/text.hpp"

namespace adit::codec {
namespace {

constexpr std::size_t kMostRows = 100'000;  // most rows that a patch may create in a list

std::optional<std::size_t> count_of(const Value& value) {
  std::uint64_t count = kMostRows + 1;
  if (const auto* const whole = std::get_if<std::int64_t>(&value.is); whole != nullptr && *whole >= 0) {
    count = static_cast<std::uint64_t>(*whole);
  }
  if (const auto* const whole = std::get_if<std::uint64_t>(&value.is)) count = *whole;
  return count > kMostRows ? std::nullopt : std::optional(static_cast<std::size_t>(count));
}

/// Copies a run of rows that stay from `before` to their places in `now`.
bool keep(const Value& run, Value::Array& before, Value::Array& now) {
  const auto* const numbers = std::get_if<Value::Array>(&run.is);
  if (numbers == nullptr || numbers->size() != 3) return false;
  const auto to = count_of((*numbers)[0]), from = count_of((*numbers)[1]), count = count_of((*numbers)[2]);
  if (!to || !from || !count || *from + *count > before.size() || *to + *count > now.size()) return false;
  // A patch may use a row several times.
  for (std::size_t i = 0; i < *count; ++i) now[*to + i] = before[*from + i];
  return true;
}

std::optional<Value> patched_list(Value::Array before, const Value::Object& patch) {
  const Value *const length = find_member(patch, "length"), *const kept = find_member(patch, "kept"),
                     *const rows = find_member(patch, "rows");
  const auto size = length == nullptr ? std::optional(before.size()) : count_of(*length);
  if (!size) return std::nullopt;
  Value::Array now;
  if (kept != nullptr) {
    now.resize(*size);
    const auto* const runs = std::get_if<Value::Array>(&kept->is);
    if (runs == nullptr) return std::nullopt;
    for (const Value& run : *runs) {
      if (!keep(run, before, now)) return std::nullopt;
    }
  } else {
    now = std::move(before);
    now.resize(*size);
  }
  if (rows == nullptr) return Value{std::move(now)};
  const auto* const changes = std::get_if<Value::Object>(&rows->is);
  if (changes == nullptr) return std::nullopt;
  for (const auto& [name, change] : *changes) {
    const auto place = icd::number_in<std::size_t>(name);
    if (!place || *place >= now.size()) return std::nullopt;
    auto row = apply_patch(std::move(now[*place]), change);
    if (!row) return std::nullopt;
    now[*place] = *std::move(row);
  }
  return Value{std::move(now)};
}

std::optional<Value> patched_object(Value::Object object, const Value::Object& patch) {
  for (const auto& [name, change] : patch) {
    Value* const known = find_member(object, name);
    if (known == nullptr) {
      object.emplace_back(name, change);
      continue;
    }
    auto value = apply_patch(std::move(*known), change);
    if (!value) return std::nullopt;
    *known = *std::move(value);
  }
  return Value{std::move(object)};
}

std::optional<Value> change(const RowKind& kind, void* before, void* now);

std::optional<Value> change(const Row& row, void* before, void* now) {
  Value::Object changes;
  for (const Member& member : row.members) {
    auto changed = change(*member.kind, member.in(before), member.in(now));
    if (!changed) continue;
    if (member.name.empty()) {
      std::ranges::move(std::get<Value::Object>(changed->is), std::back_inserter(changes));
    } else {
      changes.emplace_back(member.name, *std::move(changed));
    }
  }
  if (changes.empty()) return std::nullopt;
  return Value{std::move(changes)};
}

/// The place of each row in the list before; std::nullopt for a new row.
struct Places {
  std::vector<std::optional<std::size_t>> from;
  bool moved = false;  // whether a row moved
};

bool is_same(const RowKind& kind, void* one, void* other) {
  return kind.same != nullptr ? kind.same(one, other) : kind.write(one) == kind.write(other);
}

/// Compares rows by their `id` members.
class Identity {
 public:
  explicit Identity(const Row& row) {
    for (const std::string_view name : row.id) {
      members_.push_back(std::ranges::find(row.members, name, &Member::name));
      assert(members_.back() != row.members.end());
    }
  }
  bool is_same_row(void* one, void* other) const {
    return std::ranges::all_of(members_, [&](const auto& member) {
      return is_same(*member->kind, member->in(one), member->in(other));
    });
  }

 private:
  std::vector<std::span<const Member>::iterator> members_;
};

/// Rows mostly keep their order, so the search starts after the previous row's place.
std::optional<std::size_t> place_of(const Identity& identity, void* one, const Rows& before,
                                    std::size_t likely) {
  for (std::size_t tried = 0; tried < before.count; ++tried) {
    const std::size_t at = (likely + tried) % before.count;
    if (identity.is_same_row(before.at(at), one)) return at;
  }
  return std::nullopt;
}

Places places_of(const Row& row, const Rows& before, const Rows& now) {
  Places places{.from = std::vector<std::optional<std::size_t>>(now.count)};
  if (row.id.empty()) return places;
  const Identity identity(row);
  std::size_t likely = 0;
  for (std::size_t i = 0; i < now.count; ++i) {
    const auto from = places.from[i] = place_of(identity, now.at(i), before, likely);
    if (!from) continue;
    likely = *from + 1;
    places.moved |= *from != i;
  }
  return places;
}

/// As runs of adjacent rows.
Value::Array kept_rows(const Places& places) {
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

std::optional<Value> list_change(const Row& row, const Rows& before, const Rows& now) {
  const Places places = places_of(row, before, now);
  Value::Object list, rows;
  for (std::size_t i = 0; i < now.count; ++i) {
    const auto from = places.moved ? places.from[i] : i < before.count ? std::optional(i) : std::nullopt;
    auto changed = from ? change(row, before.at(*from), now.at(i)) : write_row(row, now.at(i));
    if (changed) rows.emplace_back(std::to_string(i), *std::move(changed));
  }
  if (now.count != before.count) list.emplace_back("length", Value{std::uint64_t{now.count}});
  if (places.moved) list.emplace_back("kept", Value{kept_rows(places)});
  if (!rows.empty()) list.emplace_back("rows", Value{std::move(rows)});
  if (list.empty()) return std::nullopt;
  return Value{std::move(list)};
}

std::optional<Value> change(const RowKind& kind, void* before, void* now) {
  if (kind.rows != nullptr) {
    const Row& row = *row_of(*kind.schema);
    const Rows rows_before = kind.rows(before), rows = kind.rows(now);
    if (kind.schema->items != nullptr) return list_change(row, rows_before, rows);
    if (rows_before.count > 0 && rows.count > 0) return change(row, rows_before.first, rows.first);
    if (rows_before.count == rows.count) return std::nullopt;  // both absent
  } else if (is_same(kind, before, now)) {
    return std::nullopt;
  }
  return kind.write(now);
}

}  // namespace

std::optional<Value> apply_patch(Value before, const Value& patch) {
  const auto* const changes = std::get_if<Value::Object>(&patch.is);
  if (changes == nullptr) return patch;
  if (auto* const list = std::get_if<Value::Array>(&before.is)) {
    return patched_list(std::move(*list), *changes);
  }
  if (auto* const object = std::get_if<Value::Object>(&before.is)) {
    return patched_object(std::move(*object), *changes);
  }
  return patch;
}

std::optional<Value> patch(const Row& row, const void* before, const void* now) {
  // only read
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
  return change(row, const_cast<void*>(before), const_cast<void*>(now));
}

}  // namespace adit::codec
