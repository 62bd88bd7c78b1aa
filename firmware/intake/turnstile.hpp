#pragma once

#include <functional>
#include <memory>
#include <string>

#include "intake/server.hpp"
#include "intake/token_guesses.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

/// Stands before a server's handler: a request with a wrong token is answered late, or its token is not
/// checked, as TokenGuesses says. A late answer holds its connection, which counts as a stranger's: so there
/// are no more of them than the strangers' share, and no bytes of a body are taken meanwhile.
class Turnstile final : public Handler {
 public:
  /// `wrong` is called with the address of each request without a right token. All outlive this.
  Turnstile(loop::Loop& loop, Handler& handler, TokenGuesses& guesses, std::chrono::milliseconds late,
            std::function<void(const std::string& address)> wrong)
      : loop_(loop), handler_(handler), guesses_(guesses), late_(late), wrong_(std::move(wrong)) {}

  /// Asked once of each request, just before open().
  Shown shown(const RequestHead& head) override;
  std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<Flow> flow) override;

 private:
  loop::Loop& loop_;
  Handler& handler_;
  TokenGuesses& guesses_;
  const std::chrono::milliseconds late_;
  const std::function<void(const std::string&)> wrong_;
  TokenGuesses::Verdict verdict_;  // of the request that is about to be opened
};

}  // namespace adit::intake
