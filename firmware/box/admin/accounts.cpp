#include "admin/accounts.hpp"

#include <unistd.h>

#include <memory>
#include <utility>

#include "access/password.hpp"
#include "admin/kept_file.hpp"
#include "host/log.hpp"
#include "host/random.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"

namespace adit::admin {
namespace {

using access::Role;
using host::Level;

constexpr const char* kUnread = "the passwords cannot be read: ";

access::Accounts accounts_in(const std::string& file, std::string& unread) {
  auto accounts = read_kept_file(file, &access::read_accounts, unread);
  if (accounts) return std::move(*accounts);
  if (!unread.empty()) {
    unread = kUnread + unread;
  } else {
    host::set_damaged_aside(file, "the list of passwords", accounts.error());
  }
  return {};
}

std::vector<access::Device> read_known(const std::string& file, const access::Accounts& accounts,
                                       std::string& unread) {
  const auto parse = [&](std::string_view json) { return access::read_devices(json, accounts); };
  auto devices = read_kept_file(file, parse, unread);
  if (devices) return std::move(*devices);
  host::log(Level::Warning, "cannot read the known devices: no browser is known", {{"why", devices.error()}});
  return {};
}

/// Returns `accounts` with a role's password changed. Slow.
icd::Checked<access::Accounts> with_password(access::Accounts accounts, Role role,
                                             const std::optional<std::string>& password,
                                             const access::Salt& salt) {
  accounts.hash_of(role).reset();
  if (!password) return accounts;
  if (access::role_of(*password, accounts)) {
    return icd::refuse(icd::Status::UnprocessableEntity,
                       "password: expected a password that the other role does not have");
  }
  auto hashed = access::hash(*password, salt);
  if (!hashed) return icd::refuse(icd::Status::ServiceUnavailable, hashed.error());
  accounts.hash_of(role) = std::move(*hashed);
  return accounts;
}

}  // namespace

Accounts::Accounts(const loop::Loop& loop, loop::Workers& workers, loop::Writer& writer,
                   SessionKeeper& sessions, std::string folder, std::optional<icd::BearerToken> label_code)
    : loop_(loop),
      workers_(workers),
      writer_(writer),
      sessions_(sessions),
      folder_(std::move(folder)),
      accounts_(accounts_in(file(), unread_)),
      devices_(read_known(devices_file(), accounts_, unread_devices_), [this] { keep_devices(); }) {
  if (!unread_.empty()) return;
  if (!first_start()) {
    unlink(code_file().c_str());  // left by a kill or copied from a card; consoles would show it
    return;
  }
  const bool on_label = label_code.has_value();
  code_ = on_label ? std::move(label_code) : kept_code();
  if (on_label) {
    host::log(Level::Notice, "no password is set: the page asks for the code on the label");
  } else if (code_) {
    host::log_to_console(Level::Notice, "no password is set: the page asks for this code",
                         {{"code", code_->reveal()}});
  }
}

/// The code of an earlier start, or a new one. std::nullopt if the file cannot be read.
std::optional<icd::BearerToken> Accounts::kept_code() {
  const auto kept = host::can_exist(code_file()) ? host::read_file(code_file()) : "";
  if (!kept) {
    unread_ = kUnread + kept.error();
    return std::nullopt;
  }
  std::string code = kept->substr(0, kept->find('\n'));
  if (!access::is_code(code)) {
    std::uint64_t random = 0;
    host::fill_random({reinterpret_cast<std::uint8_t*>(&random), sizeof random});
    code = access::code_from(random);
    host::log_failure(Level::Warning,
                      "cannot store the first start's code: the code is valid until the next start",
                      host::write_file(code_file(), code + "\n", host::kOursAlone));
  }
  return icd::BearerToken::parse(code);
}

void Accounts::check(std::string password, std::string address,
                     std::function<void(std::optional<Role>)> done) {
  auto role = std::make_shared<std::optional<Role>>();
  workers_.submit(
      loop::Urgency::OnTheWay,
      [role, password = std::move(password), accounts = accounts_] {
        *role = access::role_of(password, accounts);
      },
      [this, role, accounts = accounts_, address = std::move(address), done = std::move(done)] {
        // the password has changed since
        if (*role && accounts_.hash_of(**role) != accounts.hash_of(**role)) role->reset();
        if (*role) {
          host::log(Level::Notice, "logged in",
                    {{"role", std::string(name_of(**role))}, {"sender", address}});
        } else {
          host::log(Level::Warning, "login rejected: wrong password", {{"sender", address}});
        }
        done(*role);
      },
      [] {});  // dropping `done` answers the waiting client
}

void Accounts::set(Role role, std::optional<std::string> password,
                   std::function<void(icd::Checked<void>)> done) {
  if (!unread_.empty()) return done(icd::refuse(icd::Status::ServiceUnavailable, unread_));
  if (std::exchange(setting_, true)) {
    return done(icd::conflict("another password is being set: try again"));
  }
  access::Salt salt{};
  host::fill_random(salt);
  auto changed = std::make_shared<icd::Checked<access::Accounts>>(
      icd::refuse(icd::Status::ServiceUnavailable, "cannot set the password: try again"));
  const auto change = [changed, role, password = std::move(password), salt, accounts = accounts_] {
    *changed = with_password(accounts, role, password, salt);
  };
  const auto keep = [changed, file = file(), code_file = code_file()] {
    if (!*changed) return;
    if (const auto written = host::write_kept(file, access::write_accounts(**changed)); !written) {
      *changed =
          icd::refuse(icd::Status::ServiceUnavailable, "cannot store the password: " + written.error());
    } else {
      unlink(code_file.c_str());  // a code is valid only without a password
    }
  };
  const auto ended = [this, changed, role, done = std::move(done)] { on_password_set(role, *changed, done); };
  workers_.submit(loop::Urgency::OnTheWay, change, [this, keep, ended] { writer_.submit(keep, ended); });
}

void Accounts::on_password_set(Role role, const icd::Checked<access::Accounts>& changed,
                               const std::function<void(icd::Checked<void>)>& done) {
  setting_ = false;
  if (!changed) {
    host::log(Level::Warning, "password not set", {{"why", changed.error().sentence}});
    return done(std::unexpected(changed.error()));
  }
  accounts_ = *changed;
  if (role == Role::Operator) set_up_.close();
  host::log(Level::Notice, accounts_.hash_of(role) ? "password set" : "password removed",
            {{"role", std::string(name_of(role))}});
  done({});
}

/// After a power cut, a browser whose device was not stored loses its precedence until its next login.
void Accounts::keep_devices() {
  if (!unread_devices_.empty()) return;
  auto written = std::make_shared<std::expected<void, std::string>>();
  writer_.submit(
      [written, file = devices_file(), text = access::write_devices(devices_.all(), accounts_)] {
        *written = host::write_kept(file, text);
      },
      [written] {
        if (*written) return;
        host::log(Level::Warning, "cannot store the known devices: they are known until the next start",
                  {{"why", written->error()}});
      });
}

void Accounts::open_set_up() {
  set_up_.open(loop_.now(), kSetUp);
  host::log(Level::Warning, "set-up opened at the box: a new password can be set without the present one",
            {{"minutes", std::to_string(kSetUp.count())}});
}

access::Secret Accounts::draw() {
  access::Secret secret;
  host::fill_random(secret);
  return secret;
}

}  // namespace adit::admin
