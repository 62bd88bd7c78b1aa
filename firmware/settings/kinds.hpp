#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "codec/value.hpp"
#include "settings/settings.hpp"

namespace adit::settings {

/// What a value of the settings file may be, and which member of Settings it sets. Each kind is made for a
/// member by naming it: whole<[](auto& s) -> auto& { return s.team.connections; }>(1, 1024).
struct Flag {
  void (*put)(Settings&, bool);
  bool (*get)(const Settings&);
};

/// A whole number, or milliseconds.
struct Whole {
  void (*put)(Settings&, std::uint64_t);
  std::uint64_t (*get)(const Settings&);
  std::uint64_t least, most;
};

struct Real {
  void (*put)(Settings&, double);
  double (*get)(const Settings&);
  double least, most;
};

enum class Form : std::uint8_t {
  Address,
  Interface,
  Chip,
  Line,
  Robot,
  Alias,
  Course,
  CourseOrNone,
  Ipv4OrNone,
  Origins
};
struct Text {
  void (*put)(Settings&, std::string);
  const std::string& (*get)(const Settings&);
  Form form;
};

/// One of a few words, in the order of the enumeration that they stand for.
struct Choice {
  void (*put)(Settings&, std::size_t);
  std::size_t (*get)(const Settings&);
  std::span<const std::string_view> words;
};

/// Sets nothing: the number of the file's layout.
struct Version {};

using Kind = std::variant<Flag, Whole, Real, Text, Choice, Version>;

/// Sets the member to `value`, or says what was expected and what was found.
std::expected<void, std::string> put(const Kind& kind, const codec::Value& value, Settings& settings);

/// "1 to 65535"
std::string range_of(const Kind& kind);

/// The member's value as the settings file has it.
codec::Value value_of(const Kind& kind, const Settings& settings);

/// "flag", "whole", "real", "text", "choice" or "version"
std::string_view name_of(const Kind& kind);

/// A value for a sentence: as JSON and not too long, or what it is ("an object").
std::string shown(const codec::Value& value);

template <auto member>
constexpr Flag flag() {
  return {[](Settings& s, bool value) { member(s) = value; }, [](const Settings& s) { return member(s); }};
}

template <auto member>
constexpr Whole whole(std::uint64_t least, std::uint64_t most) {
  using Member = std::remove_reference_t<decltype(member(std::declval<Settings&>()))>;
  return {[](Settings& s, std::uint64_t value) { member(s) = static_cast<Member>(value); },
          [](const Settings& s) {
            if constexpr (requires { member(s).count(); }) {
              return static_cast<std::uint64_t>(member(s).count());
            } else {
              return static_cast<std::uint64_t>(member(s));
            }
          },
          least, most};
}

template <auto member>
constexpr Real real(double least, double most) {
  return {[](Settings& s, double value) { member(s) = value; }, [](const Settings& s) { return member(s); },
          least, most};
}

template <auto member>
constexpr Text text(Form form) {
  return {[](Settings& s, std::string value) { member(s) = std::move(value); },
          [](const Settings& s) -> const std::string& { return member(s); }, form};
}

template <auto member>
constexpr Choice choice(std::span<const std::string_view> words) {
  using Member = std::remove_cvref_t<decltype(member(std::declval<Settings&>()))>;
  return {[](Settings& s, std::size_t value) { member(s) = static_cast<Member>(value); },
          [](const Settings& s) { return static_cast<std::size_t>(member(s)); }, words};
}

}  // namespace adit::settings
