#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "access/devices.hpp"
#include "access/role.hpp"
#include "access/sessions.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// What the login needs of the box: passwords, sessions and random bytes. To be called on the loop. Hashing
/// takes tens of milliseconds, so functions that hash answer later, on the loop.
class Keys {
 public:
  virtual ~Keys() = default;

  /// Why the passwords cannot be read, as a sentence; or "". Then none is right or wrong.
  virtual const std::string& unread() const = 0;
  /// No operator's password is set: the code sets it.
  virtual bool first_start() const = 0;
  /// False where it is not the first start.
  virtual bool is_code(std::string_view presented) const = 0;

  /// Somebody at the box opened set-up with its button: until a password is set, anybody may set the
  /// operator's without the present one or the code.
  virtual bool set_up_open() const = 0;
  /// Its button was pressed within the last minute.
  virtual bool somebody_at_box() const = 0;

  /// Says whose password it is, if anybody's. `address`: the client's, for the log.
  virtual void check(std::string password, std::string address,
                     std::function<void(std::optional<access::Role>)> done) = 0;

  /// Sets a role's password, which has passed access::check_new(); nothing removes it (the viewer's only).
  /// Refused: 409 while another is being set, 422 if it is the other role's, 503 if it cannot be kept.
  virtual void set(access::Role role, std::optional<std::string> password,
                   std::function<void(icd::Checked<void>)> done) = 0;

  /// Those who are logged in; kept over a restart of the service.
  virtual access::Sessions& sessions() = 0;
  /// The browsers that have been in; kept over a restart of the box.
  virtual access::Devices& devices() = 0;

  /// Never the same twice.
  virtual access::Secret draw() = 0;
};

}  // namespace adit::api
