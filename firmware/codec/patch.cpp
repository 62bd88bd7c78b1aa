#include "codec/patch.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

namespace adit::codec {
namespace {

std::optional<Value> change(const Kind& kind, void* before, void* now);

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

bool is_same(const Kind& kind, void* one, void* other) {
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

std::optional<Value> list_change(const Row& row, const Rows& before, const Rows& now) {
  const Places places = places_of(row, before, now);
  Value::Object list, rows;
  for (std::size_t i = 0; i < now.count; ++i) {
    const auto from = places.moved ? places.from[i] : i < before.count ? std::optional(i) : std::nullopt;
    auto changed = from ? change(row, before.at(*from), now.at(i)) : write_row(row, now.at(i));
    if (changed) rows.emplace_back(std::to_string(i), *std::move(changed));
  }
  if (now.count != before.count) list.emplace_back("length", Value{std::uint64_t{now.count}});
  if (places.moved) list.emplace_back("kept", Value{kept(places)});
  if (!rows.empty()) list.emplace_back("rows", Value{std::move(rows)});
  if (list.empty()) return std::nullopt;
  return Value{std::move(list)};
}

std::optional<Value> change(const Kind& kind, void* before, void* now) {
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

std::optional<Value> patch(const Row& row, const void* before, const void* now) {
  // only read
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
  return change(row, const_cast<void*>(before), const_cast<void*>(now));
}

}  // namespace adit::codec
