#include "codec/row.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "codec/json.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

/// A member's address in a row that is only read.
const void* address_in(const Member& member, const void* row) {
  return member.in(const_cast<void*>(row));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

template <class Number>
Number* pointer_to(const Member& member, void* row) {
  return member.kind == &kind_of<Number> ? static_cast<Number*>(member.in(row)) : nullptr;
}

}  // namespace

const Row* row_of(const Schema& schema) {
  return schema.items != nullptr ? schema.items->row : schema.row;
}

std::string list_alternatives(std::span<const std::string_view> words, std::string_view quote) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text.append(quote).append(words[i]).append(quote);
  }
  return text;
}

Value write_row(const Row& row, const void* from) {
  Value::Object object;
  object.reserve(row.members.size());
  for (const Member& member : row.members) {
    Value value = member.kind->write(address_in(member, from));
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
    if (auto* const number = pointer_to<double>(member, in)) *number = changed(*number);
    if (auto* const number = pointer_to<std::optional<double>>(member, in); number != nullptr && *number) {
      **number = changed(**number);
    }
    if (member.kind->rows == nullptr) continue;
    const Rows rows = member.kind->rows(member.in(in));
    for (std::size_t i = 0; i < rows.count; ++i) {
      change_numbers(*row_of(*member.kind->schema), rows.at(i), changed);
    }
  }
}

namespace {

using Whole = std::numeric_limits<std::int64_t>;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

constexpr std::string_view kFormatMember = "format";
constexpr std::int64_t kFormat = 1;

void check_row(const Row& row, const Field& field, std::string_view besides);

void check_value(const Schema& schema, const Field& field) {
  if (schema.has_reader) return;
  if (schema.row != nullptr) return check_row(*schema.row, field, "");
  if (schema.items == nullptr) return;
  for (std::size_t i = 0; i < field.size() && !field.reading().has_refusal(); ++i) {
    const Field element = field.element(i);
    check_value(*schema.items, element);
  }
}

void check_member(const Member& member, const Field& field) {
  if (field.is_absent()) return;  // its kind decides whether it may be absent
  if (!member.words.empty() && std::ranges::find(member.words, field.text()) == member.words.end())
    return field.refuse("expected ", list_alternatives(member.words));
  if (member.form != nullptr && !member.form->fits(field.text()))
    return field.refuse("expected ", member.form->range);
  const Schema& schema = *member.kind->schema;
  if (schema.type == "number") field.number(member.least.value_or(-kNoLimit), member.most.value_or(kNoLimit));
  if (schema.type == "integer")
    field.integer(member.least ? static_cast<std::int64_t>(*member.least) : Whole::min(),
                  member.most ? static_cast<std::int64_t>(*member.most) : Whole::max());
  check_value(schema, field);
}

/// Checks names, words, forms and bounds, which the members' kinds do not. `besides`: an additional member.
void check_row(const Row& row, const Field& field, std::string_view besides) {
  if (!field.is<Value::Object>()) return field.refuse_kind("an object");
  for (const auto& [name, value] : std::get<Value::Object>(field.value()->is)) {
    if (name != besides && std::ranges::find(row.members, name, &Member::name) == row.members.end())
      field.refuse("no such member: ", icd::quote_text(name));
  }
  for (const Member& member : row.members) {
    icd::require(!member.name.empty());  // files do not use rows with members of other rows
    const Field inner = field.member(member.name);
    check_member(member, inner);
  }
}

}  // namespace

void read_member(const Member& member, const Field& field, void* into) {
  check_member(member, field);
  member.kind->read(field, member.in(into));
}

std::string write_row_file(const Row& row, const void* from) {
  Value value = write_row(row, from);
  auto& members = std::get<Value::Object>(value.is);
  members.insert(members.begin(), {std::string(kFormatMember), {kFormat}});
  return write_json(value) + '\n';
}

std::string read_row_file(const Row& row, void* into, std::string_view json) {
  const auto root = parse_json(json);
  if (!root) return "not JSON: " + root.error();
  Reading reading;
  const Field field(*root, reading);
  field.member(kFormatMember).integer<std::int64_t>(kFormat, kFormat);
  check_row(row, field, kFormatMember);
  read_row(row, field, into);
  const auto outcome = reading.outcome(true);
  return outcome ? "" : outcome.error().sentence;
}

}  // namespace adit::codec
