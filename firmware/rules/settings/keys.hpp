#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "codec/value.hpp"
#include "settings/settings.hpp"

namespace adit::settings {

/// A valid form of text.
struct Form {
  bool (*fits)(const std::string& text);
  std::string_view range;
};
extern const Form kAddress, kInterface, kChip, kLine, kRobot, kAlias, kCourse, kCourseOrNone, kIpv4OrNone,
    kOrigins;

/// The valid values of a setting, and the member of Settings that it sets. Example: whole<[](auto& s) ->
/// auto& { return s.team.connections; }>(1, 1024).
struct Kind {
  enum class Of : std::uint8_t { Flag, Whole, Real, Text, Choice, Version };
  /// Version: the number of the file's layout, without a member.
  Of of = Of::Version;
  /// Read and write the member: a flag, a whole number (also milliseconds, or a word's index), a number or a
  /// text.
  codec::Value (*get)(const Settings&) = [](const Settings&) { return codec::Value{std::uint64_t{1}}; };
  void (*put)(Settings&, const codec::Value&) = [](Settings&, const codec::Value&) {};
  double least = 1, most = 1;                    // of a number
  const Form* form = nullptr;                    // of a text
  std::span<const std::string_view> words = {};  // of a choice, in enumeration order
};

/// Sets the member to `value`. The error names the expected and the found value.
std::expected<void, std::string> put(const Kind& kind, const codec::Value& value, Settings& settings);

/// "1 to 65535"
std::string range_of(const Kind& kind);

/// The member's value in the settings file.
codec::Value value_of(const Kind& kind, const Settings& settings);

/// `least` or `most` in the settings file.
codec::Value bound_of(const Kind& kind, double bound);

/// "flag", "whole", "real", "text", "choice" or "version"
std::string_view name_of(const Kind& kind);

/// 1 to `longest` letters, digits, `_` and `-`.
bool is_word(std::string_view text, std::size_t longest);

/// A value for a sentence: short JSON, or its type ("an object").
std::string shown(const codec::Value& value);

template <auto member>
constexpr Kind kind(Kind::Of of) {
  using Member = std::remove_cvref_t<decltype(member(std::declval<Settings&>()))>;
  constexpr bool kAsItIs =
      std::is_same_v<Member, bool> || std::is_same_v<Member, double> || std::is_same_v<Member, std::string>;
  return {.of = of,
          .get = [](const Settings& s) -> codec::Value {
            if constexpr (kAsItIs) {
              return {member(s)};
            } else if constexpr (requires { member(s).count(); }) {
              return {static_cast<std::uint64_t>(member(s).count())};
            } else {
              return {static_cast<std::uint64_t>(member(s))};
            }
          },
          .put =
              [](Settings& s, const codec::Value& value) {
                using Given = std::conditional_t<kAsItIs, Member, std::uint64_t>;
                member(s) = static_cast<Member>(std::get<Given>(value.is));
              }};
}

template <auto member>
constexpr Kind flag() {
  return kind<member>(Kind::Of::Flag);
}

template <auto member>
constexpr Kind whole(std::uint64_t least, std::uint64_t most) {
  Kind whole = kind<member>(Kind::Of::Whole);
  whole.least = static_cast<double>(least), whole.most = static_cast<double>(most);
  return whole;
}

template <auto member>
constexpr Kind real(double least, double most) {
  Kind real = kind<member>(Kind::Of::Real);
  real.least = least, real.most = most;
  return real;
}

template <auto member>
constexpr Kind text(const Form& form) {
  Kind text = kind<member>(Kind::Of::Text);
  text.form = &form;
  return text;
}

template <auto member>
constexpr Kind choice(std::span<const std::string_view> words) {
  Kind choice = kind<member>(Kind::Of::Choice);
  choice.words = words;
  return choice;
}

/// One key of the settings file.
struct Key {
  std::string_view path;  // "team.listen[].port"; "[]" stands for each item; `kind` refers to the last item
  std::string_view meaning;
  Kind kind;
  bool required = false;
};

/// The table of all keys, for the parser and README.md. Keys of one object are adjacent.
std::span<const Key> keys();

/// One list of the settings file.
struct List {
  std::string_view path;    // "team.listen"
  std::size_t least, most;  // items
  std::size_t (*size)(const Settings&);
  void (*resize)(Settings&, std::size_t);
};

/// Requires the path of a list.
const List& list_at(std::string_view path);
/// Default settings with one more item in each list, so that each key's kind can be read.
Settings with_an_item_of_each();

/// A named member of an object in the settings file.
struct Child {
  std::string_view name;
  const Key* key = nullptr;  // null for an object or a list
  bool list = false;
};

/// The members of the object at `prefix` ("team.listen[]."), in table order.
std::vector<Child> children_of(std::string_view prefix);

}  // namespace adit::settings
