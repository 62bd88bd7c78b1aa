#include "access/role.hpp"

namespace adit::access {

std::string_view name_of(Role role) {
  return role == Role::Operator ? "operator" : "viewer";
}

std::optional<Role> role_named(std::string_view name) {
  for (const Role role : {Role::Viewer, Role::Operator}) {
    if (name == name_of(role)) return role;
  }
  return std::nullopt;
}

}  // namespace adit::access
