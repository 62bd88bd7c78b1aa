#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "access/role.hpp"

namespace adit::access {

/// Each role's password, hashed; nothing: nobody can log in as that.
struct Accounts {
  std::optional<std::string> viewer, operator_;

  std::optional<std::string>& of(Role role) { return role == Role::Operator ? operator_ : viewer; }
  const std::optional<std::string>& of(Role role) const {
    return role == Role::Operator ? operator_ : viewer;
  }
  friend bool operator==(const Accounts&, const Accounts&) = default;
};

/// Which password `hash` was made of, and nothing about it: its salt, which no other has.
std::string_view salt_of(std::string_view hash);

/// The role whose password this is. As slow as matches(): for a worker.
std::optional<Role> role_of(const std::string& password, const Accounts& accounts);

/// The text of access.json, {"version": 1, "operator": HASH, "viewer": HASH or null}; an error says what is
/// wrong and shows no hash.
std::expected<Accounts, std::string> read_accounts(std::string_view json);
std::string write_accounts(const Accounts& accounts);

}  // namespace adit::access
