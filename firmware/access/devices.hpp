#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "access/accounts.hpp"
#include "access/role.hpp"
#include "access/sessions.hpp"
#include "icd/bearer_token.hpp"

namespace adit::access {

/// A browser that somebody has logged in from. It keeps showing the id, also when it is logged out; that lets
/// nobody in, but needs no turn among strangers who guess (OWASP, "Device Cookies").
struct Device {
  std::uint64_t number = 0;  // from 1 on, another after each start
  Role role = Role::Viewer;
  icd::BearerToken id;
};

/// Those that are known.
class Devices {
 public:
  static constexpr std::size_t kMostOfRole = 16;  // at one more, the one that was not seen for longest goes

  /// `changed`, if given, is called whenever one is added or ended, or another password is theirs.
  explicit Devices(std::vector<Device> kept = {}, std::function<void()> changed = {});

  /// The one whose id is presented, seen now, or null; valid until the next call.
  const Device* find(std::string_view id);
  /// `id` has never been used before; valid until the next call.
  const Device& add(const Secret& id, Role role);
  /// Its password is another: of a role, all but one (0: no exception).
  void end_all(Role role, std::uint64_t but);

  /// Seen last comes last.
  const std::vector<Device>& all() const { return devices_; }

 private:
  std::vector<Device> devices_;
  std::function<void()> changed_;
  std::uint64_t last_ = 0;
};

/// The text of devices.json, {"version": 2, "devices": [{"role", "password", "id"}, ...]}, where "password"
/// is salt_of() the one that the role has in `accounts`.
std::string write_devices(const std::vector<Device>& devices, const Accounts& accounts);
/// Without those that were written under another password than `accounts` has: whichever of the two files was
/// written last, a device ends with the password. An error says what is wrong and shows nothing of what is in
/// it.
std::expected<std::vector<Device>, std::string> read_devices(std::string_view json, const Accounts& accounts);

}  // namespace adit::access
