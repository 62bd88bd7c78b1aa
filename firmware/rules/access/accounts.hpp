#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "access/role.hpp"

namespace adit::access {

/// Each role's password hash (crypt(5)). If it is absent, login with that role is not possible.
struct Accounts {
  std::optional<std::string> viewer, operator_;

  std::optional<std::string>& of(Role role) { return role == Role::Operator ? operator_ : viewer; }
  const std::optional<std::string>& of(Role role) const {
    return role == Role::Operator ? operator_ : viewer;
  }
  friend bool operator==(const Accounts&, const Accounts&) = default;
};

/// The part of `hash` before the hash proper. Its salt makes it unique, so it identifies the password without
/// revealing it.
std::string_view salt_of(std::string_view hash);

/// The role with this password, or nullopt. Takes up to twice as long as matches(), so call it on a worker.
std::optional<Role> role_of(const std::string& password, const Accounts& accounts);

/// The text of access.json: {"version": 1, "operator": HASH, "viewer": HASH or null}. An error says what is
/// wrong and contains no hash.
std::expected<Accounts, std::string> read_accounts(std::string_view json);
std::string write_accounts(const Accounts& accounts);

}  // namespace adit::access
