#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "codec/value.hpp"
#include "icd/geometry.hpp"
#include "icd/run_status.hpp"

/// Rows: structs whose members are described once. Their JSON, its reading, CSV and OpenAPI's schemas come
/// from the description; a new member is a line of its struct and a line of its table.
namespace adit::codec {

class Schemas;
struct Member;

/// What a struct is to whoever reads its JSON.
struct Row {
  std::string_view name;  // among OpenAPI's schemas; "": it is described where it is used
  std::span<const Member> members;
  std::string_view meaning = "";
};

/// How the values of one C++ type are written, read and described.
struct Kind {
  Value (*write)(const void* value);
  /// Refuses what is no such value, and leaves something harmless.
  void (*read)(const Field& field, void* value);
  /// JSON Schema of it, as OpenAPI 3.1 has it.
  Value::Object (*schema)(Schemas& schemas);
  const Row* row;  // of a row, or of one that may be absent; else null
};

/// How a member stands in CSV: not at all, as it is, as ISO 8601, or empty where it is 0.
enum class Cell : std::uint8_t { None, Plain, Time, NotZero };

/// One member of a row.
struct Member {
  std::string_view name;     // "": a row whose members stand among these
  std::string_view meaning;  // what the name does not say: unit, what "" or 0 means
  const Kind* kind;
  void* (*in)(void* row);
  std::span<const std::string_view> words = {};  // text that is one of these; empty: any
  std::optional<std::int64_t> least = {}, most = {};
  Cell cell = Cell::None;
  int column = 0;  // of CSV, from 1

  /// The same but for one of these; before those that call it, for clang.
  template <class T>
  constexpr Member with(T Member::* which, T value) const {
    Member other = *this;
    other.*which = value;
    return other;
  }

  constexpr Member as(const Kind& other) const { return with(&Member::kind, &other); }
  constexpr Member one_of(std::span<const std::string_view> all) const { return with(&Member::words, all); }
  constexpr Member from(std::int64_t bound) const { return with(&Member::least, std::optional(bound)); }
  constexpr Member to(std::int64_t bound) const { return with(&Member::most, std::optional(bound)); }
  constexpr Member csv(int place, Cell form = Cell::Plain) const {
    return with(&Member::cell, form).with(&Member::column, place);
  }
};

/// The schemas that have names, gathered as others refer to them: OpenAPI's components.schemas.
class Schemas {
 public:
  /// The schema of a row, or a reference to it where it has a name.
  Value::Object of(const Row& row);
  /// A reference to that schema by that name.
  Value::Object named(std::string_view name, Value::Object schema);
  Value::Object& all() { return all_; }

 private:
  Value::Object all_;
};

/// A schema, or null.
Value::Object or_null(Value::Object schema);

Value write_row(const Row& row, const void* from);
void read_row(const Row& row, const Field& field, void* into);

/// What the Kind of each type does.
template <class T>
struct KindOf;

template <class T>
constexpr const Row* row_in() {
  if constexpr (requires { KindOf<T>::row(); }) return &KindOf<T>::row();
  return nullptr;
}

template <class T>
inline constexpr Kind kind_of = {
    .write = [](const void* value) -> Value { return KindOf<T>::write(*static_cast<const T*>(value)); },
    .read = [](const Field& field, void* value) { KindOf<T>::read(field, *static_cast<T*>(value)); },
    .schema = &KindOf<T>::schema,
    .row = row_in<T>()};

template <>
struct KindOf<std::string> {
  static Value write(const std::string& text) { return {text}; }
  static void read(const Field& field, std::string& text) { text = field.text(); }
  static Value::Object schema(Schemas& /*schemas*/) { return {{"type", {"string"}}}; }
};

template <>
struct KindOf<bool> {
  static Value write(bool value) { return {value}; }
  static void read(const Field& field, bool& value) { value = field.truth(); }
  static Value::Object schema(Schemas& /*schemas*/) { return {{"type", {"boolean"}}}; }
};

template <>
struct KindOf<double> {
  static Value write(double number) { return {number}; }
  static void read(const Field& field, double& number) { number = field.number(); }
  static Value::Object schema(Schemas& /*schemas*/) { return {{"type", {"number"}}}; }
};

template <std::signed_integral Whole>
struct KindOf<Whole> {
  static Value write(Whole number) { return {std::int64_t{number}}; }
  static void read(const Field& field, Whole& number) { number = field.whole<Whole>(); }
  static Value::Object schema(Schemas& /*schemas*/) { return {{"type", {"integer"}}}; }
};

/// Counts: JSON's are below 2^63.
template <std::unsigned_integral Count>
struct KindOf<Count> {
  static Value write(Count number) { return {std::uint64_t{number}}; }
  static void read(const Field& field, Count& number) {
    number = static_cast<Count>(field.whole<std::int64_t>(0));
  }
  static Value::Object schema(Schemas& /*schemas*/) {
    return {{"type", {"integer"}}, {"minimum", {std::int64_t{0}}}};
  }
};

/// Of a row whose description is `kRow`.
template <class T, const Row& kRow>
struct KindOfRow {
  static Value write(const T& row) { return write_row(kRow, &row); }
  static void read(const Field& field, T& row) { read_row(kRow, field, &row); }
  static Value::Object schema(Schemas& schemas) { return schemas.of(kRow); }
  static constexpr const Row& row() { return kRow; }
};

/// A struct that says so itself: static const codec::Row kRow.
template <class T>
  requires requires { T::kRow; }
struct KindOf<T> : KindOfRow<T, T::kRow> {};

extern const Row kPoint, kRunStatus;
template <>
struct KindOf<icd::Point> : KindOfRow<icd::Point, kPoint> {};
template <>
struct KindOf<icd::RunStatus> : KindOfRow<icd::RunStatus, kRunStatus> {};

/// For the Kind of what nobody reads.
struct OnlyWritten {
  static void read(const Field& field, auto& /*value*/) { field.refuse("it is only written"); }
};

/// null where there is nothing.
template <class T>
struct KindOf<std::optional<T>> {
  static constexpr const Row& row()
    requires requires { KindOf<T>::row(); }
  {
    return KindOf<T>::row();
  }
  static Value write(const std::optional<T>& value) { return value ? KindOf<T>::write(*value) : Value{}; }
  static void read(const Field& field, std::optional<T>& value) {
    value.reset();
    if (!field.is_absent()) KindOf<T>::read(field, value.emplace());
  }
  static Value::Object schema(Schemas& schemas) { return or_null(KindOf<T>::schema(schemas)); }
};

template <class T>
struct KindOf<std::vector<T>> {
  static Value write(const std::vector<T>& all) {
    Value::Array array;
    array.reserve(all.size());
    for (const T& each : all) array.push_back(KindOf<T>::write(each));
    return {std::move(array)};
  }
  static void read(const Field& field, std::vector<T>& all) {
    all.clear();
    for (std::size_t i = 0; i < field.size() && !field.reading().refused(); ++i) {
      const Field element = field.element(i);
      KindOf<T>::read(element, all.emplace_back());
    }
  }
  static Value::Object schema(Schemas& schemas) {
    return {{"type", {"array"}}, {"items", {KindOf<T>::schema(schemas)}}};
  }
};

/// Text that is null where it is empty.
extern const Kind kTextOrNull;

/// The member at the end of a way of pointers to members, of the row that the first one is of.
template <auto first, auto... rest>
constexpr Member member(std::string_view name, std::string_view meaning = "") {
  return [=]<class In, class T>(T In::* /*first*/) {
    using Last = std::remove_cvref_t<decltype(((std::declval<In&>().*first).*....*rest))>;
    return Member{name, meaning, &kind_of<Last>,
                  [](void* row) -> void* { return &((static_cast<In*>(row)->*first).*....*rest); }};
  }(first);
}

template <class T>
Value json(const T& value) {
  return KindOf<T>::write(value);
}
/// The same as text.
template <class T>
std::string to_json(const T& value) {
  return write_json(json(value));
}

}  // namespace adit::codec
