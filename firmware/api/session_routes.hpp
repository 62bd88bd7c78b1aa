#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "access/failures.hpp"
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
  SessionRoutes(loop::Loop& loop, Entrance& entrance, Keys& keys)
      : loop_(loop), entrance_(entrance), keys_(keys) {}

  /// Takes in /adit/reset, too: it needs a password like those here. `setup` outlives this.
  void serve(Setup& setup) { setup_ = &setup; }

  static bool has(std::string_view path);
  /// Requires has(head.path()).
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder);

 private:
  using Replies = std::shared_ptr<intake::Responder>;

  /// Who posts, kept while a password is checked.
  struct Poster {
    std::string address, agent;
    bool admitted = false;      // as an operator
    std::uint64_t session = 0;  // 0: none
  };
  /// What is asked of /adit/password.
  struct Change {
    access::Role role = access::Role::Operator;
    std::optional<std::string> password;  // nothing: none any more
    std::string current, code;
  };

  intake::Answer shown(const intake::RequestHead& head);
  intake::Answer session(const intake::RequestHead& head);
  intake::Answer sessions(const intake::RequestHead& head);
  std::unique_ptr<intake::BodySink> post(const intake::RequestHead& head, Replies responder);

  void log_in(const Poster& poster, const std::string& body, const Replies& responder);
  intake::Answer logged_in(access::Role role, const Poster& poster);
  intake::Answer log_out(const intake::RequestHead& head);
  intake::Answer end(const intake::RequestHead& head, std::uint64_t number);

  void change_password(const Poster& poster, const std::string& body, const Replies& responder);
  bool is_by_button(const Change& change) const;
  void reset(const Poster& poster, const std::string& body, const Replies& responder);
  void set(const Change& change, const Poster& poster, const Replies& responder);

  /// Calls `done` with whose password it is; answers 429 instead where it is not to be checked now.
  template <class Done>
  void check(const std::string& password, const Poster& poster, const Replies& responder, Done done);
  /// False: it is answered 429.
  bool may_try(const Poster& poster, const Replies& responder);
  static icd::Checked<Change> read_change(const std::string& body);

  loop::Loop& loop_;
  Entrance& entrance_;
  Keys& keys_;
  Setup* setup_ = nullptr;
  access::Failures failures_;
  int checking_ = 0;
};

}  // namespace adit::api
