#include "access/accounts.hpp"

#include <algorithm>

#include "access/password.hpp"
#include "access/role.hpp"
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
    if (accounts.hash_of(role) && matches(password, *accounts.hash_of(role))) return role;
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

namespace {

constexpr std::int64_t kDevicesVersion = 2;

std::string_view password_of(Role role, const Accounts& accounts) {
  return accounts.hash_of(role) ? salt_of(*accounts.hash_of(role)) : "";
}

std::optional<Device> device_in(const codec::Field& object, const Accounts& accounts) {
  const auto role = role_in(object);
  const auto id = token_in(object, "id");
  const std::string_view password = object.member("password").text();
  if (!role || !id || !accounts.hash_of(*role) || password != password_of(*role, accounts))
    return std::nullopt;
  return Device{.role = *role, .id = *id};
}

}  // namespace

Devices::Devices(std::vector<Device> kept, std::function<void()> changed)
    : devices_(std::move(kept)), changed_(std::move(changed)) {
  for (Device& device : devices_) device.number = ++last_;
}

const Device* Devices::find(std::string_view id) {
  auto found = devices_.end();
  for (auto each = devices_.begin(); each != devices_.end(); ++each) {
    if (each->id.matches(id)) found = each;  // no early exit: the time must not reveal which one matches
  }
  if (found == devices_.end()) return nullptr;
  std::rotate(found, found + 1, devices_.end());
  return &devices_.back();
}

const Device& Devices::add(const Secret& id, Role role) {
  const auto is_of_role = [role](const Device& device) { return device.role == role; };
  if (std::ranges::count_if(devices_, is_of_role) >= static_cast<std::ptrdiff_t>(kMostOfRole)) {
    devices_.erase(std::ranges::find_if(devices_, is_of_role));
  }
  devices_.push_back({.number = ++last_, .role = role, .id = to_token(id)});
  if (changed_) changed_();
  return devices_.back();
}

void Devices::end_all(Role role, std::uint64_t but) {
  const auto is_of_role = [role](const Device& device) { return device.role == role; };
  const bool concerns = std::ranges::any_of(devices_, is_of_role);
  std::erase_if(devices_, [&](const Device& device) { return is_of_role(device) && device.number != but; });
  if (concerns && changed_) changed_();
}

std::string write_devices(const std::vector<Device>& devices, const Accounts& accounts) {
  Value::Array rows;
  for (const Device& device : devices) {
    rows.push_back({Value::Object{{"role", {std::string(name_of(device.role))}},
                                  {"password", {std::string(password_of(device.role, accounts))}},
                                  {"id", {device.id.reveal()}}}});
  }
  return codec::write_json({Value::Object{{"version", {kDevicesVersion}}, {"devices", {std::move(rows)}}}}) +
         '\n';
}

std::expected<std::vector<Device>, std::string> read_devices(std::string_view json,
                                                             const Accounts& accounts) {
  return read_kept<std::vector<Device>>(json, kDevicesVersion, [&accounts](const codec::Field& object) {
    return elements_of<Device>(object.member("devices"),
                               [&](const codec::Field& each) { return device_in(each, accounts); });
  });
}

}  // namespace adit::access
