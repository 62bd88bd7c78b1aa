#pragma once

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <iterator>
#include <limits>
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
#include "icd/members.hpp"
#include "icd/scoring.hpp"

/// Rows: structs with described members. JSON, its reading, CSV and OpenAPI's schemas (schemas.hpp) use the
/// description. A new member is one line of its struct and one line of its table.
namespace adit::codec {

struct Member;

/// Description of a struct for readers of its JSON.
struct Row {
  std::string_view name;  // name of the OpenAPI schema; "": described in place
  std::span<const Member> members;
  std::string_view meaning = "";
  std::span<const std::string_view> id = {};  // members that identify a row of a list; empty: its place does
};

/// OpenAPI's description of one C++ type.
struct Schema {
  std::string_view type = "";        // JSON type: "string"; "" for rows
  const Row* row = nullptr;          // of a row or an optional row
  const Schema* items = nullptr;     // of an array
  std::size_t fewest = 0, most = 0;  // items; 0: unlimited
  std::optional<std::int64_t> least = {};
  std::string_view more = "";  // more JSON: R"("pattern":"^#[0-9a-f]{6}$")"
  std::string_view name = "";  // name of the OpenAPI schema; "": described in place
  bool or_null = false;
  bool has_reader = false;  // has a reader that checks the members

  constexpr Schema nullable() const {
    Schema other = *this;
    other.or_null = true;
    return other;
  }
};

/// Contiguous structs of one row.
struct Rows {
  void* first = nullptr;
  std::size_t count = 0, size = 0;  // size: of one struct, in bytes

  void* at(std::size_t place) const { return static_cast<std::byte*>(first) + place * size; }
};

/// The row of a row or a list of rows, or null.
const Row* row_of(const Schema& schema);

/// Functions for one C++ type: writing, reading, description, and comparison for patches.
struct RowKind {
  using Same = bool (*)(const void* one, const void* other);
  using ToRows = Rows (*)(void* value);
  using Add = void* (*)(void* value);

  Value (*write)(const void* value);
  /// Refuses another value and leaves a harmless one.
  void (*read)(const Field& field, void* value);
  const Schema* schema;
  /// Whether both are written alike; null: compare the written values.
  Same same = nullptr;
  /// The row, if present, or the rows of a list; null: not rows.
  ToRows rows = nullptr;
  /// Adds a row to a list, or creates an optional row, and returns it; null: neither.
  Add add = nullptr;
};

/// Form in CSV: none, plain, ISO 8601, or empty if 0.
enum class Cell : std::uint8_t { None, Plain, Time, NotZero };

/// A rule for texts.
struct Form {
  bool (*fits)(std::string_view text);
  std::string_view range;  // "an IPv4 address"
};

struct Member {
  std::string_view name;     // "": a row whose members are among these
  std::string_view meaning;  // beyond the name: unit, meaning of "" or 0
  const RowKind* kind;
  void* (*in)(void* row);
  std::span<const std::string_view> words = {};  // possible values of a text; empty: any
  const Form* form = nullptr;                    // of a text; null: any
  std::optional<double> least = {}, most = {};   // of a number, or of the number of a list's items
  Cell cell = Cell::None;
  int column = 0;         // in CSV, from 1
  bool is_needed = true;  // false: may be missing; left out if null
  bool is_exact = false;  // its numbers are identifiers and never rounded
  bool is_made = false;   // of the whole row, not of one member of the struct

  /// A copy with one property changed; before its callers, for clang.
  template <class T>
  constexpr Member with(T Member::* which, T value) const {
    Member other = *this;
    other.*which = value;
    return other;
  }

  constexpr Member as(const RowKind& other) const { return with(&Member::kind, &other); }
  constexpr Member one_of(std::span<const std::string_view> all) const { return with(&Member::words, all); }
  constexpr Member optional() const { return with(&Member::is_needed, false); }
  constexpr Member exact() const { return with(&Member::is_exact, true); }
  constexpr Member matching(const Form& one) const { return with(&Member::form, &one); }
  constexpr Member from(double bound) const { return with(&Member::least, std::optional(bound)); }
  constexpr Member to(double bound) const { return with(&Member::most, std::optional(bound)); }
  constexpr Member within(double lowest, double highest) const { return from(lowest).to(highest); }
  constexpr Member csv(int place, Cell cell_form = Cell::Plain) const {
    return with(&Member::cell, cell_form).with(&Member::column, place);
  }
};

/// The row of a struct with a line for each member, but for `left_out` members. Otherwise compilation ends.
template <class Struct, std::size_t left_out = 0>
consteval Row complete(const Row& row) {
  std::size_t members = left_out;
  for (const Member& member : row.members) members += member.is_made ? 0 : 1;
  if (members != icd::count_of_members<Struct>()) throw "a member of the struct has no line in its table";
  return row;
}

Value write_row(const Row& row, const void* from);
void read_row(const Row& row, const Field& field, void* into);
/// Reads a member of the row `into`. Refuses a value outside of its words, form or bounds.
void read_member(const Member& member, const Field& field, void* into);
/// Changes all reals in the row and its rows, except those of exact members.
void change_numbers(const Row& row, void* in, double (*changed)(double));

/// The functions of a type's RowKind.
template <class T>
struct KindOf;

template <class T>
concept IsCompared = requires(const T& value) { KindOf<T>::same(value, value); };
template <class T>
concept IsRow = requires(T& value) { KindOf<T>::rows_at(&value, 1); };

template <class T, class As>
constexpr RowKind::Same same_as() {
  if constexpr (requires(const T& value) { As::same(value, value); }) {
    return [](const void* one, const void* other) {
      return As::same(*static_cast<const T*>(one), *static_cast<const T*>(other));
    };
  } else {
    return nullptr;
  }
}
template <class T, class As>
constexpr RowKind::ToRows rows_as() {
  if constexpr (requires(T& value) { As::rows(value); }) {
    return [](void* value) { return As::rows(*static_cast<T*>(value)); };
  } else {
    return nullptr;
  }
}

template <class T, class As>
constexpr RowKind::Add adder_of() {
  if constexpr (requires(T& value) { As::add(value); }) {
    return [](void* value) -> void* { return &As::add(*static_cast<T*>(value)); };
  } else {
    return nullptr;
  }
}

/// A RowKind from a class with KindOf's members; `same`, `rows` and `add` are optional.
template <class T, class As>
inline constexpr RowKind kind_as = {
    .write = [](const void* value) -> Value { return As::write(*static_cast<const T*>(value)); },
    .read = [](const Field& field, void* value) { As::read(field, *static_cast<T*>(value)); },
    .schema = &As::schema,
    .same = same_as<T, As>(),
    .rows = rows_as<T, As>(),
    .add = adder_of<T, As>()};
template <class T>
inline constexpr const RowKind& kind_of = kind_as<T, KindOf<T>>;

/// For types that are written alike exactly if they are equal.
struct Equal {
  static bool same(const auto& one, const auto& other) { return one == other; }
};

template <>
struct KindOf<std::string> : Equal {
  static Value write(const std::string& text) { return {text}; }
  static void read(const Field& field, std::string& text) { text = field.text(); }
  static constexpr Schema schema = {.type = "string"};
};

template <>
struct KindOf<bool> : Equal {
  static Value write(bool value) { return {value}; }
  static void read(const Field& field, bool& value) { value = field.truth(); }
  static constexpr Schema schema = {.type = "boolean"};
};

/// The number of its periods.
template <class Count, class Period>
struct KindOf<std::chrono::duration<Count, Period>> : Equal {
  using Time = std::chrono::duration<Count, Period>;
  static Value write(Time time) { return {std::int64_t{time.count()}}; }
  static void read(const Field& field, Time& time) { time = Time(field.integer<Count>()); }
  static constexpr Schema schema = {.type = "integer"};
};

template <>
struct KindOf<Value> : Equal {
  static Value write(const Value& value) { return value; }
  static void read(const Field& field, Value& value) { value = field.value() ? *field.value() : Value{}; }
  static constexpr Schema schema = {};
};

template <>
struct KindOf<double> : Equal {
  static Value write(double number) { return {number}; }
  static void read(const Field& field, double& number) { number = field.number(); }
  static constexpr Schema schema = {.type = "number"};
};

template <std::signed_integral Whole>
struct KindOf<Whole> : Equal {
  static Value write(Whole number) { return {std::int64_t{number}}; }
  static void read(const Field& field, Whole& number) { number = field.integer<Whole>(); }
  static constexpr Schema schema = {.type = "integer"};
};

/// Counts; JSON's are below 2^63.
template <std::unsigned_integral Count>
struct KindOf<Count> : Equal {
  static Value write(Count number) { return {std::uint64_t{number}}; }
  static void read(const Field& field, Count& number) {
    constexpr std::uint64_t kMost =
        std::min<std::uint64_t>(std::numeric_limits<Count>::max(), std::numeric_limits<std::int64_t>::max());
    number = static_cast<Count>(field.integer<std::int64_t>(0, static_cast<std::int64_t>(kMost)));
  }
  static constexpr Schema schema = {.type = "integer", .least = 0};
};

template <class T, const Row& kRow>
struct KindOfRow {
  static Value write(const T& row) { return write_row(kRow, &row); }
  static void read(const Field& field, T& row) { read_row(kRow, field, &row); }
  static Rows rows(T& row) { return rows_at(&row, 1); }
  static Rows rows_at(T* first, std::size_t count) { return {first, count, sizeof(T)}; }
  static constexpr Schema schema = {.row = &kRow};
};

/// A struct with static const codec::Row kRow.
template <class T>
  requires requires { T::kRow; }
struct KindOf<T> : KindOfRow<T, T::kRow> {};

/// "a, b or c", for a sentence. `quote`: around each word.
std::string list_alternatives(std::span<const std::string_view> words, std::string_view quote = "");

/// A number or enum that is written as one of these words, in order from 0.
template <class Index, const auto& kWords>
struct KindOfWord : Equal {
  static Value write(Index value) { return {std::string(kWords[static_cast<std::size_t>(value)])}; }
  static void read(const Field& field, Index& value) {
    const auto* const word = std::find(std::begin(kWords), std::end(kWords), field.text());
    if (word == std::end(kWords)) return field.refuse("expected ", list_alternatives(kWords));
    value = static_cast<Index>(word - std::begin(kWords));
  }
  static constexpr Schema schema = {.type = "string"};
};

/// An enum whose namespace has words_of(Enum): an array of its words.
template <class Enum>
  requires requires(Enum value) { words_of(value); }
struct KindOf<Enum> : KindOfWord<Enum, words_of(Enum{})> {};

/// For types that are never read.
struct WriteOnly {
  static void read(const Field& field, auto& /*value*/) { field.refuse("it is only written"); }
};

/// null if empty.
template <class T>
struct KindOf<std::optional<T>> {
  static Value write(const std::optional<T>& value) { return value ? KindOf<T>::write(*value) : Value{}; }
  static void read(const Field& field, std::optional<T>& value) {
    value.reset();
    if (!field.is_absent()) KindOf<T>::read(field, value.emplace());
  }
  static bool same(const std::optional<T>& one, const std::optional<T>& other)
    requires IsCompared<T>
  {
    return one && other ? KindOf<T>::same(*one, *other) : one.has_value() == other.has_value();
  }
  static Rows rows(std::optional<T>& value)
    requires IsRow<T>
  {
    return value ? KindOf<T>::rows_at(&*value, 1) : Rows{};
  }
  static T& add(std::optional<T>& value)
    requires IsRow<T>
  {
    return value.emplace();
  }
  static constexpr Schema schema = KindOf<T>::schema.nullable();
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
    for (std::size_t i = 0; i < field.size() && !field.reading().has_refusal(); ++i) {
      const Field element = field.element(i);
      KindOf<T>::read(element, all.emplace_back());
    }
  }
  static bool same(const std::vector<T>& one, const std::vector<T>& other)
    requires IsCompared<T>
  {
    return std::ranges::equal(one, other, [](const T& a, const T& b) { return KindOf<T>::same(a, b); });
  }
  static Rows rows(std::vector<T>& all)
    requires IsRow<T>
  {
    return KindOf<T>::rows_at(all.data(), all.size());
  }
  static T& add(std::vector<T>& all)
    requires IsRow<T>
  {
    return all.emplace_back();
  }
  static constexpr Schema schema = {.type = "array", .items = &KindOf<T>::schema};
};

inline constexpr Schema kTextOrNullSchema = KindOf<std::string>::schema.nullable();
inline constexpr RowKind kTextOrNull = {
    .write = [](const void* value) -> Value {
      const auto& all = *static_cast<const std::string*>(value);
      return all.empty() ? Value{} : Value{all};
    },
    .read = [](const Field& field,
               void* value) { *static_cast<std::string*>(value) = field.is_absent() ? "" : field.text(); },
    .schema = &kTextOrNullSchema};

template <auto... at, class In, class T>
auto type_at(T In::*) -> std::remove_cvref_t<decltype((std::declval<In&>().*....*at))>;
/// The type of the member at a path of pointers to members.
template <auto first, auto... rest>
using TypeAt = decltype(type_at<first, rest...>(first));

/// The member at a path of pointers to members, which starts in the row. `As` has KindOf's members.
template <class As, auto first, auto... rest>
constexpr Member member_of_kind(std::string_view name, std::string_view meaning = "") {
  return [=]<class In, class T>(T In::* /*first*/) {
    return Member{name, meaning, &kind_as<TypeAt<first, rest...>, As>,
                  [](void* row) -> void* { return &((static_cast<In*>(row)->*first).*....*rest); }};
  }(first);
}
template <auto first, auto... rest>
constexpr Member member(std::string_view name, std::string_view meaning = "") {
  return member_of_kind<KindOf<TypeAt<first, rest...>>, first, rest...>(name, meaning);
}

/// A member computed from the whole row.
template <class In, class As>
constexpr Member made_of(std::string_view name, std::string_view meaning = "") {
  return Member{name, meaning, &kind_as<In, As>, [](void* row) { return row; }}.with(&Member::is_made, true);
}
/// Members of the row as a nested object.
template <class In, const Row& kGroup>
constexpr Member group(std::string_view name, std::string_view meaning = "") {
  return made_of<In, KindOfRow<In, kGroup>>(name, meaning);
}

inline constexpr Member kPointMembers[] = {member<&icd::Point::x>("x"), member<&icd::Point::y>("y"),
                                           member<&icd::Point::z>("z")};
inline constexpr Row kPoint = {"Point", kPointMembers, "Metres, in the frame darpa."};
template <>
struct KindOf<icd::Point> : KindOfRow<icd::Point, kPoint> {};

inline constexpr Member kRunStatusMembers[] = {
    member<&icd::RunStatus::score>("score"),
    member<&icd::RunStatus::run_clock>("run_clock", "seconds"),
    member<&icd::RunStatus::remaining_reports>("remaining_reports"),
    member<&icd::RunStatus::current_team>("current_team"),
};
inline constexpr Row kRunStatus = {"", kRunStatusMembers, "As last heard."};
template <>
struct KindOf<icd::RunStatus> : KindOfRow<icd::RunStatus, kRunStatus> {};

template <class T>
Value json(const T& value) {
  return KindOf<T>::write(value);
}
template <class T>
std::string to_json(const T& value) {
  return write_json(json(value));
}

// Small files of aditd and root programs: messages and state. Each is a row as JSON with "format": 1.

std::string write_row_file(const Row& row, const void* from);
/// A sentence about the first error, or "".
std::string read_row_file(const Row& row, void* into, std::string_view json);

template <class T>
std::string write_file(const T& row) {
  return write_row_file(T::kRow, &row);
}

/// Strict, also in nested rows. Errors name the member: missing, unknown, or outside words, form or bounds.
template <class T>
std::expected<T, std::string> read_file(std::string_view json) {
  T row;
  if (auto fault = read_row_file(T::kRow, &row, json); !fault.empty())
    return std::unexpected(std::move(fault));
  return row;
}

}  // namespace adit::codec
