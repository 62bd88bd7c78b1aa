#pragma once

#include <functional>
#include <memory>
#include <string>

#include "intake/server.hpp"
#include "intake/token_guesses.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

/// Wraps a server's handler: answers a request with a wrong token late, or does not check its token, as
/// TokenGuesses decides. A late answer holds its connection, which counts as unauthenticated. So the share of
/// unauthenticated connections limits late answers, and no bytes of a body are read meanwhile.
class Turnstile final : public Handler {
 public:
  /// `wrong` is called with the address of each request without a right token. The references must outlive
  /// this object.
  Turnstile(loop::Loop& loop, Handler& handler, TokenGuesses& guesses, std::chrono::milliseconds late,
            std::function<void(const std::string& address)> wrong)
      : loop_(loop), handler_(handler), guesses_(guesses), late_(late), wrong_(std::move(wrong)) {}

  /// Called once for each request, just before open().
  Credentials shown(const RequestHead& head) override;
  std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<Flow> flow) override;

 private:
  loop::Loop& loop_;
  Handler& handler_;
  TokenGuesses& guesses_;
  const std::chrono::milliseconds late_;
  const std::function<void(const std::string&)> wrong_;
  TokenGuesses::Verdict verdict_;  // of the next request to open
};

}  // namespace adit::intake
