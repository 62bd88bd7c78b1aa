#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "access/accounts.hpp"
#include "access/role.hpp"
#include "access/sessions.hpp"
#include "api/scene.hpp"
#include "codec/row.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// A logged-in user.
struct SessionRow {
  std::uint64_t number = 0;
  access::Role role = access::Role::Viewer;
  std::string address, agent;
  Time made = 0, seen = 0;
  bool own = false;

  static const codec::Row kRow;
};

/// The first question of a page.
struct SessionView {
  std::optional<access::Role> role;  // nullopt: not logged in
  std::string csrf;                  // "": none
  bool first_start = false, set_up_open = false;
  bool secure = false, https = false;

  static const codec::Row kRow;
};

/// The box's part in logins: passwords, sessions and random bytes. Call on the loop. Functions that hash,
/// which takes tens of milliseconds, answer later on the loop.
class Keys {
 public:
  virtual ~Keys() = default;

  /// Why the passwords cannot be read, as a sentence; then none is right or wrong. "": they can be read.
  virtual const std::string& unread() const = 0;
  /// Whether the operator's password is missing. The code sets it.
  virtual bool first_start() const = 0;
  /// False if this is not the first start.
  virtual bool is_code(std::string_view presented) const = 0;

  /// Whether a person opened set-up with the box's button. Until a password is set, any client may set the
  /// operator's without the present one or the code.
  virtual bool set_up_open() const = 0;
  /// Whether the button was pressed within the last minute.
  virtual bool is_operator_at_box() const = 0;

  /// Passes the role of the password to `done`, or std::nullopt. `address`: the client's, for the log.
  virtual void check(std::string password, std::string address,
                     std::function<void(std::optional<access::Role>)> done) = 0;

  /// Sets a role's password, which must have passed access::check_new(). std::nullopt removes a viewer's.
  /// Error: 409 while another is being set, 422 if the other role has it, 503 if it cannot be stored.
  virtual void set(access::Role role, std::optional<std::string> password,
                   std::function<void(icd::Checked<void>)> done) = 0;

  /// Survive a restart of the service.
  virtual access::Sessions& sessions() = 0;
  /// Known devices; survive a boot.
  virtual access::Devices& devices() = 0;

  /// A new random value at each call.
  virtual access::Secret draw() = 0;
};

}  // namespace adit::api
