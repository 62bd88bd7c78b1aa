#pragma once

#include <memory>
#include <optional>
#include <string>

#include "access/guesses.hpp"
#include "api/authenticator.hpp"
#include "api/certificate.hpp"
#include "api/keys.hpp"
#include "api/setup.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// Login, logout, passwords, sessions, and the reset that ends them all. Routes: README.md.
class SessionRoutes {
 public:
  static constexpr int kMostChecks = 4;  // queued password checks: each needs memory, and one runs at a time

  /// All must outlive this object, and pending answers of `keys`.
  SessionRoutes(loop::Loop& loop, Authenticator& authenticator, Keys& keys, Setup& setup,
                Certificate& certificate)
      : loop_(loop), authenticator_(authenticator), keys_(keys), setup_(setup), certificate_(certificate) {}

  intake::Answer session(const intake::RequestHead& head);
  intake::Answer sessions(const Call& call);
  void log_in(const Call& call);
  intake::Answer log_out(const Call& call);
  intake::Answer end(std::uint64_t number);
  void change_password(const Call& call);
  void reset(const Call& call);

 private:
  /// The client, stored while a password is checked.
  struct Poster {
    access::Guesser guesser;
    std::string agent, host;
    bool is_secure = false;  // by TLS
    Asker asker;
    std::shared_ptr<intake::Responder> responder;
  };
  /// A request to /adit/password.
  struct Change {
    access::Role role = access::Role::Operator;
    std::optional<std::string> password;  // nullopt: remove it
    std::string current, code;
  };

  Poster poster_of(const Call& call);
  static icd::Checked<Change> read_change(const std::string& body);
  intake::Answer logged_in(access::Role role, const Poster& poster);
  /// The role of the client's known device, if any.
  std::optional<access::Role> device_role(const Poster& poster);
  bool is_by_button(const Change& change) const;
  void set(const Change& change, const Poster& poster);

  /// Checks the posted "password", and passes its role and the poster to `done`.
  template <class Done>
  void check_posted(const Call& call, Done done);
  /// Passes the role of the password to `done`, or answers 429 if it may not be checked now.
  template <class Done>
  void check(const std::string& password, const Poster& poster, Done done);
  /// False: answered with 429 or 503.
  bool check_limit(const Poster& poster);

  loop::Loop& loop_;
  Authenticator& authenticator_;
  Keys& keys_;
  Setup& setup_;
  Certificate& certificate_;
  access::Guesses guesses_;
  int checking_ = 0;
};

}  // namespace adit::api
