#include "codec/apply_patch.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "icd/text.hpp"

namespace adit::codec {
namespace {

constexpr std::size_t kMostRows = 100'000;  // most rows that a patch may create in a list

const Value* member_of(const Value::Object& object, std::string_view name) {
  const auto found = std::ranges::find(object, name, &Value::Member::first);
  return found == object.end() ? nullptr : &found->second;
}

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
  const Value *const length = member_of(patch, "length"), *const kept = member_of(patch, "kept"),
                     *const rows = member_of(patch, "rows");
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
    const auto known = std::ranges::find(object, name, &Value::Member::first);
    if (known == object.end()) {
      object.emplace_back(name, change);
      continue;
    }
    auto value = apply_patch(std::move(known->second), change);
    if (!value) return std::nullopt;
    known->second = *std::move(value);
  }
  return Value{std::move(object)};
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

}  // namespace adit::codec
