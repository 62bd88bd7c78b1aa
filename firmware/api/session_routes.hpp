#pragma once

#include <memory>
#include <optional>
#include <string>

#include "access/guesses.hpp"
#include "api/entrance.hpp"
#include "api/keys.hpp"
#include "api/setup.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// Logging in and out, passwords, sessions, and the reset that ends them all: README.md has the routes.
class SessionRoutes {
 public:
  static constexpr int kMostChecks =
      4;  // of passwords at once: each takes memory, and one after the other is checked

  /// All outlive this, and whatever `keys` still answers.
  SessionRoutes(loop::Loop& loop, Entrance& entrance, Keys& keys, Setup& setup)
      : loop_(loop), entrance_(entrance), keys_(keys), setup_(setup) {}

  intake::Answer session(const intake::RequestHead& head);
  intake::Answer sessions(const Call& call);
  void log_in(const Call& call);
  intake::Answer log_out(const Call& call);
  intake::Answer end(std::uint64_t number);
  void change_password(const Call& call);
  void reset(const Call& call);

 private:
  /// Who posts, kept while a password is checked.
  struct Poster {
    access::Guesser guesser;
    std::string agent;
    Asker asker;
    std::shared_ptr<intake::Responder> responder;
  };
  /// What is asked of /adit/password.
  struct Change {
    access::Role role = access::Role::Operator;
    std::optional<std::string> password;  // nothing: none any more
    std::string current, code;
  };

  Poster poster_of(const Call& call);
  static icd::Checked<Change> read_change(const std::string& body);
  intake::Answer logged_in(access::Role role, const Poster& poster);
  /// The role of the browser that has been in, if it has.
  std::optional<access::Role> known_as(const Poster& poster);
  bool is_by_button(const Change& change) const;
  void set(const Change& change, const Poster& poster);

  /// Calls `done` with the role whose password it is; answers 429 instead if it is not to be checked now.
  template <class Done>
  void check(const std::string& password, const Poster& poster, Done done);
  /// False: it is answered 429.
  bool may_try(const Poster& poster);

  loop::Loop& loop_;
  Entrance& entrance_;
  Keys& keys_;
  Setup& setup_;
  access::Guesses guesses_;
  int checking_ = 0;
};

}  // namespace adit::api
