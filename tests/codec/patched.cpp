#include "codec/patched.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace adit::codec::test {
namespace {

using Array = Value::Array;
using Object = Value::Object;

Value* member(Object& object, std::string_view name) {
  const auto found = std::ranges::find(object, name, &Value::Member::first);
  return found == object.end() ? nullptr : &found->second;
}

std::size_t count_in(const Value& value) {
  if (const auto* number = std::get_if<std::uint64_t>(&value.is)) return *number;
  return static_cast<std::size_t>(std::get<std::int64_t>(value.is));
}

std::size_t place_in(std::string_view text) {
  std::size_t place = 0;
  std::from_chars(text.data(), text.data() + text.size(), place);
  return place;
}

Value& at(Array& list, std::size_t place) {
  if (place >= list.size()) list.resize(place + 1);
  return list[place];
}

Value patched_list(const Array& list, Object patch) {
  Array next;
  if (const Value* const kept = member(patch, "kept")) {
    for (const Value& run : std::get<Array>(kept->is)) {
      const auto& numbers = std::get<Array>(run.is);
      const std::size_t to = count_in(numbers.at(0)), from = count_in(numbers.at(1));
      for (std::size_t i = 0; i < count_in(numbers.at(2)); ++i) at(next, to + i) = list.at(from + i);
    }
  } else {
    next = list;
  }
  if (const Value* const length = member(patch, "length")) next.resize(count_in(*length));
  if (const Value* const rows = member(patch, "rows")) {
    for (const auto& [place, row] : std::get<Object>(rows->is)) {
      Value& there = at(next, place_in(place));
      there = patched(there, row);
    }
  }
  return {std::move(next)};
}

}  // namespace

Value patched(const Value& value, const Value& patch) {
  const auto* const changes = std::get_if<Object>(&patch.is);
  if (changes == nullptr) return patch;
  if (const auto* const list = std::get_if<Array>(&value.is)) return patched_list(*list, *changes);
  const auto* const object = std::get_if<Object>(&value.is);
  if (object == nullptr) return patch;
  Object next = *object;
  for (const auto& [name, change] : *changes) {
    if (Value* const known = member(next, name)) {
      *known = patched(*known, change);
    } else {
      next.emplace_back(name, change);
    }
  }
  return {std::move(next)};
}

}  // namespace adit::codec::test
