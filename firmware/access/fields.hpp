#pragma once

#include <optional>
#include <string_view>

#include "access/role.hpp"
#include "codec/field.hpp"
#include "icd/bearer_token.hpp"

namespace adit::access {

/// Refuses, and gives nothing, where the text cannot be one.
inline std::optional<icd::BearerToken> token_in(const codec::Field& object, std::string_view name) {
  const codec::Field field = object.member(name);
  auto token = icd::BearerToken::parse(field.text());
  if (!token) field.refuse("expected a token");
  return token;
}

/// The member `role`; refuses, and gives nothing, where it is none.
inline std::optional<Role> role_in(const codec::Field& object) {
  const codec::Field field = object.member("role");
  auto role = role_named(field.text());
  if (!role) field.refuse("expected operator or viewer");
  return role;
}

}  // namespace adit::access
