#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/bearer_token.hpp"

namespace adit::access {

using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// A viewer looks. An operator also acts. Each role includes the previous ones.
enum class Role : std::uint8_t { Viewer, Operator };

/// "viewer", "operator"
constexpr std::string_view name_of(Role role) {
  return role == Role::Operator ? "operator" : "viewer";
}

constexpr std::optional<Role> role_named(std::string_view name) {
  for (const Role role : {Role::Viewer, Role::Operator}) {
    if (name == name_of(role)) return role;
  }
  return std::nullopt;
}

/// Parses a JSON object with this "version" and returns the result of `read`. Errors contain no secret.
template <class Kept, class Read>
std::expected<Kept, std::string> read_kept(std::string_view json, std::int64_t version, Read read) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("the text is not JSON: " + root.error());
  codec::Reading reading;
  const codec::Field object(*root, reading);
  const codec::Field said = object.member("version");
  if (said.integer<std::int64_t>() != version) said.refuse("expected ", version);
  auto outcome = reading.outcome<Kept>(read(object));
  if (!outcome) return std::unexpected(outcome.error().sentence);
  return std::move(*outcome);
}

/// `read_element` of each element; skips those without a result, and stops at the first refused element.
template <class Element, class Read>
std::vector<Element> elements_of(const codec::Field& array, Read read_element) {
  std::vector<Element> all;
  const std::size_t count = array.size();
  for (std::size_t i = 0; i < count && !array.reading().has_refusal(); ++i) {
    if (std::optional<Element> each = read_element(array.element(i))) all.push_back(std::move(*each));
  }
  return all;
}

/// The token in member `name`. Refuses and returns nullopt if it cannot be a token.
inline std::optional<icd::BearerToken> token_in(const codec::Field& object, std::string_view name) {
  const codec::Field field = object.member(name);
  auto token = icd::BearerToken::parse(field.text());
  if (!token) field.refuse("expected a token");
  return token;
}

/// The role in member `role`. Refuses and returns nullopt if it is no role.
inline std::optional<Role> role_in(const codec::Field& object) {
  const codec::Field field = object.member("role");
  auto role = role_named(field.text());
  if (!role) field.refuse("expected operator or viewer");
  return role;
}

}  // namespace adit::access
