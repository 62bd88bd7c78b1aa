#include "codec/row.hpp"

#include <algorithm>
#include <iterator>

namespace adit::codec {
namespace {

/// A member's address in a row that is only read.
const void* in(const Member& member, const void* row) {
  return member.in(const_cast<void*>(row));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

template <class Number>
Number* as(const Member& member, void* row) {
  return member.kind == &kind_of<Number> ? static_cast<Number*>(member.in(row)) : nullptr;
}

}  // namespace

const Row* row_of(const Schema& schema) {
  return schema.items != nullptr ? schema.items->row : schema.row;
}

std::string in_turn(std::span<const std::string_view> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

Value write_row(const Row& row, const void* from) {
  Value::Object object;
  object.reserve(row.members.size());
  for (const Member& member : row.members) {
    Value value = member.kind->write(in(member, from));
    if (!member.is_needed && std::holds_alternative<std::nullptr_t>(value.is)) continue;
    if (member.name.empty()) {
      std::ranges::move(std::get<Value::Object>(value.is), std::back_inserter(object));
    } else {
      object.emplace_back(member.name, std::move(value));
    }
  }
  return {std::move(object)};
}

void read_row(const Row& row, const Field& field, void* into) {
  for (const Member& member : row.members) {
    if (member.name.empty()) {
      member.kind->read(field, member.in(into));
    } else {
      const Field inner = field.member(member.name);
      member.kind->read(inner, member.in(into));
    }
  }
}

void change_numbers(const Row& row, void* in, double (*changed)(double)) {
  for (const Member& member : row.members) {
    if (member.is_exact) continue;
    if (auto* const number = as<double>(member, in)) *number = changed(*number);
    if (auto* const number = as<std::optional<double>>(member, in); number != nullptr && *number) {
      **number = changed(**number);
    }
    if (member.kind->rows == nullptr) continue;
    const Rows rows = member.kind->rows(member.in(in));
    for (std::size_t i = 0; i < rows.count; ++i) {
      change_numbers(*row_of(*member.kind->schema), rows.at(i), changed);
    }
  }
}

}  // namespace adit::codec
