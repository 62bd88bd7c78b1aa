#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "access/role.hpp"
#include "access/sessions.hpp"
#include "icd/bearer_token.hpp"

namespace adit::access {

/// Each role's password hash (crypt(5)). If it is absent, login with that role is not possible.
struct Accounts {
  std::optional<std::string> viewer, operator_;

  std::optional<std::string>& hash_of(Role role) { return role == Role::Operator ? operator_ : viewer; }
  const std::optional<std::string>& hash_of(Role role) const {
    return role == Role::Operator ? operator_ : viewer;
  }
  friend bool operator==(const Accounts&, const Accounts&) = default;
};

/// `hash` without the hash proper. Its unique salt identifies the password without revealing it.
std::string_view salt_of(std::string_view hash);

/// The role with this password, or nullopt. Takes up to twice as long as matches(), so call it on a worker.
std::optional<Role> role_of(const std::string& password, const Accounts& accounts);

/// The text of access.json: {"version": 1, "operator": HASH, "viewer": HASH or null}. Errors contain no hash.
std::expected<Accounts, std::string> read_accounts(std::string_view json);
std::string write_accounts(const Accounts& accounts);

/// A known device: a browser from which a password was shown. Its cookie stays after the logout. The cookie
/// is no login, but it exempts the browser from waiting for a turn (OWASP, "Device Cookies").
struct Device {
  std::uint64_t number = 0;  // from 1 on, new after each process start
  Role role = Role::Viewer;
  icd::BearerToken id;
};

class Devices {
 public:
  static constexpr std::size_t kMostOfRole = 16;  // beyond it, add() drops the one not seen for longest

  /// `changed`, if given, is called when a device is added, and by end_all() if the role has devices.
  explicit Devices(std::vector<Device> kept = {}, std::function<void()> changed = {});

  /// The device with this id, or null. Marks it as seen now. The result is valid until the next call.
  const Device* find(std::string_view id);
  /// `id` must be new. The result is valid until the next call.
  const Device& add(const Secret& id, Role role);
  /// Call this when the role's password has changed. Removes the role's devices except number `but` (0: all).
  void end_all(Role role, std::uint64_t but);

  /// The device seen last comes last.
  const std::vector<Device>& all() const { return devices_; }

 private:
  std::vector<Device> devices_;
  std::function<void()> changed_;
  std::uint64_t last_ = 0;
};

/// devices.json: {"version": 2, "devices": [{"role", "password", "id"}, ...]}; "password" is its salt_of().
std::string write_devices(const std::vector<Device>& devices, const Accounts& accounts);
/// Skips devices that were written under another password than the one in `accounts`. So a device ends with
/// its password, whichever of the two files was written last. Errors contain no secret.
std::expected<std::vector<Device>, std::string> read_devices(std::string_view json, const Accounts& accounts);

/// A time in which a person at the box is trusted. No network request opens it. A restart closes it.
class Window {
 public:
  /// Opens it for `length` from now, even if it is open already.
  void open(Instant now, Duration length) { until_ = now + length; }
  void close() { until_.reset(); }
  /// The rest of its time, or nullopt if it is closed.
  std::optional<Duration> remaining(Instant now) const {
    return until_ && now < *until_ ? std::optional<Duration>(*until_ - now) : std::nullopt;
  }

 private:
  std::optional<Instant> until_;
};

}  // namespace adit::access
