#pragma once

#include <optional>
#include <string>

#include "access/accounts.hpp"
#include "access/password.hpp"
#include "admin/kept_file.hpp"
#include "api/keys.hpp"
#include "icd/bearer_token.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::admin {

/// The passwords. If their file or the code's file cannot be read, no password is set and all logins are
/// rejected. A damaged file of passwords is set aside; the code then sets new ones.
class Accounts final : public api::Keys {
 public:
  /// In the state directory: the password hashes. Before the first password: the code, unless on the label.
  static constexpr const char* kFile = "access.json";
  static constexpr const char* kCodeFile = access::kCodeFile;
  /// Also there: the known devices. An unreadable file stays unchanged until the next start.
  static constexpr const char* kDevicesFile = "devices.json";
  static constexpr std::chrono::minutes kSetUp{10}, kAtBox{1};  // validity of the button's press

  /// Logs the code of a first start, unless it is on the label. `workers` compute hashes and must have no
  /// other jobs. `loop`, `workers`, `writer` and `sessions` must outlive this object.
  Accounts(const loop::Loop& loop, loop::Workers& workers, loop::Writer& writer, SessionKeeper& sessions,
           std::string folder, std::optional<icd::BearerToken> label_code);

  /// Why a file cannot be read, as a sentence; or "". The next process reads it again.
  const std::string& unread() const override { return unread_; }
  bool first_start() const override { return !accounts_.operator_ && unread_.empty(); }
  bool is_code(std::string_view presented) const override {
    return first_start() && code_ && code_->matches(presented);
  }
  bool set_up_open() const override { return set_up_left().has_value(); }
  void check(std::string password, std::string address,
             std::function<void(std::optional<access::Role>)> done) override;
  void set(access::Role role, std::optional<std::string> password,
           std::function<void(icd::Checked<void>)> done) override;
  access::Sessions& sessions() override { return sessions_.sessions(); }
  access::Devices& devices() override { return devices_; }
  bool is_operator_at_box() const override { return at_box_.remaining(loop_.now()).has_value(); }
  access::Secret draw() override;

  /// The code for the first password, if none was set at the start.
  const std::optional<icd::BearerToken>& code() const { return code_; }

  /// Call only for the box's own button.
  void open_set_up();
  void on_button_press() { at_box_.open(loop_.now(), kAtBox); }
  std::optional<access::Duration> set_up_left() const { return set_up_.remaining(loop_.now()); }

 private:
  std::string file() const { return folder_ + '/' + kFile; }
  std::string code_file() const { return folder_ + '/' + kCodeFile; }
  std::string devices_file() const { return folder_ + '/' + kDevicesFile; }
  std::optional<icd::BearerToken> kept_code();
  void keep_devices();
  void on_password_set(access::Role role, const icd::Checked<access::Accounts>& changed,
                       const std::function<void(icd::Checked<void>)>& done);

  const loop::Loop& loop_;
  loop::Workers& workers_;
  loop::Writer& writer_;
  SessionKeeper& sessions_;
  std::string folder_, unread_, unread_devices_;
  access::Accounts accounts_;
  std::optional<icd::BearerToken> code_;
  access::Devices devices_;
  access::Window set_up_, at_box_;
  bool setting_ = false;
};

}  // namespace adit::admin
