#include "access/accounts.hpp"

#include "access/fields.hpp"
#include "access/password.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"

namespace adit::access {
namespace {

using codec::Value;

constexpr std::int64_t kVersion = 1;

std::optional<std::string> hash_in(const codec::Field& object, std::string_view name) {
  const codec::Field field = object.member(name);
  if (field.is_absent()) return std::nullopt;
  const std::string_view text = field.text();
  if (!text.starts_with("$y$")) field.refuse("expected a yescrypt hash");
  return std::string(text);
}

Value value_of(const std::optional<std::string>& hash) {
  return hash ? Value{*hash} : Value{};
}

}  // namespace

std::string_view salt_of(std::string_view hash) {
  return hash.substr(0, hash.rfind('$'));
}

std::optional<Role> role_of(const std::string& password, const Accounts& accounts) {
  for (const Role role : {Role::Operator, Role::Viewer}) {
    if (accounts.of(role) && matches(password, *accounts.of(role))) return role;
  }
  return std::nullopt;
}

std::expected<Accounts, std::string> read_accounts(std::string_view json) {
  return read_kept<Accounts>(json, kVersion, [](const codec::Field& object) {
    return Accounts{.viewer = hash_in(object, "viewer"), .operator_ = hash_in(object, "operator")};
  });
}

std::string write_accounts(const Accounts& accounts) {
  return codec::write_json({Value::Object{{"version", {kVersion}},
                                          {"operator", value_of(accounts.operator_)},
                                          {"viewer", value_of(accounts.viewer)}}}) +
         '\n';
}

}  // namespace adit::access
