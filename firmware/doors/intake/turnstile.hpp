#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

/// Slows down clients that guess bearer tokens.
///
/// Each address may try kFree wrong tokens at once, then one each kEach. The same wrong token again is no
/// guess, because it gives its sender no information, but its answer may be late. So a robot with an old
/// token does not use up the guesses of others behind the same router. A right token is always accepted, with
/// one exception: an address that has guessed too often and has never shown a right token. Then no token is
/// checked, because each answer would show whether a guess was right.
class TokenGuesses {
 public:
  static constexpr int kFree = 10;
  static constexpr std::chrono::seconds kEach{1};
  /// Beyond it, an address is removed, if possible one without a right token.
  static constexpr std::size_t kMostAddresses = 256;

  enum class TokenCheck : std::uint8_t { Right, Wrong, NotChecked };
  struct Verdict {
    TokenCheck looked = TokenCheck::Right;
    bool late = false;  // delay its answer

    friend bool operator==(const Verdict&, const Verdict&) = default;
  };

  /// For a request from `address` with a right token.
  Verdict right(const std::string& address, loop::Instant now);
  /// For a request from `address` with the wrong `token`; "": without the required token.
  Verdict wrong(const std::string& address, std::string_view token, loop::Instant now);
  /// Call this when the tokens have changed.
  void forget() { counts_.clear(); }

 private:
  /// kFree at once, then one each kEach.
  class Allowance {
   public:
    bool has_guess(loop::Instant now) const { return used_up_to_ - now <= kEach * (kFree - 1); }
    void use(loop::Instant now) { used_up_to_ = std::max(used_up_to_, now) + kEach; }

   private:
    loop::Instant used_up_to_{};
  };
  struct Count {
    bool has_been_right = false;
    loop::Instant last{};
    Allowance guesses, answers;
    std::array<std::string, 8> wrong;  // the last ones, cut to a token's length
    std::size_t next = 0;              // the next one to replace
  };
  Count& count_of(const std::string& address, loop::Instant now);

  std::map<std::string, Count, std::less<>> counts_;
};

/// Wraps a server's handler: answers a request with a wrong token late, or does not check its token, as
/// TokenGuesses decides. A late answer holds its connection, which counts as unauthenticated. So the share of
/// unauthenticated connections limits late answers, and no bytes of a body are read meanwhile.
class Turnstile final : public Handler {
 public:
  using Refused = std::function<void(CloseReason why, const std::string& address)>;

  /// `refused` is called for each request with a wrong token, and for each POST to a URI of the ICD without
  /// one. Other requests without a token are browsers or monitors. The references must outlive this object.
  Turnstile(loop::Loop& loop, Handler& handler, TokenGuesses& guesses, std::chrono::milliseconds late,
            Refused refused)
      : loop_(loop), handler_(handler), guesses_(guesses), late_(late), refused_(std::move(refused)) {}

  /// Called once for each request, just before open().
  Credentials read_credentials(const RequestHead& head) override;
  std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<FlowControl> flow) override;

 private:
  loop::Loop& loop_;
  Handler& handler_;
  TokenGuesses& guesses_;
  const std::chrono::milliseconds late_;
  const Refused refused_;
  TokenGuesses::Verdict verdict_;  // of the next request to open
};

}  // namespace adit::intake
