#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "loop/loop.hpp"

namespace adit::intake {

/// Slows down who guesses bearer tokens, and nobody else.
///
/// Of each address, kFree wrong tokens are checked and answered at once, then one each kEach. The same wrong
/// token again is no guess, because it tells its sender nothing new, but its answer comes late: a robot with
/// an old token uses up no guesses of others behind the same router. A right token is always let in, unless
/// its address has guessed too much and has never shown a right one: then no token is checked, because each
/// answer would tell whether a guess was right.
class TokenGuesses {
 public:
  static constexpr int kFree = 10;
  static constexpr std::chrono::seconds kEach{1};
  static constexpr std::size_t kMostAddresses =
      256;  // at one more, one goes that has never shown a right one

  enum class Looked : std::uint8_t { Right, Wrong, NotLookedAt };
  struct Verdict {
    Looked looked = Looked::Right;
    bool late = false;  // its answer is to come late

    friend bool operator==(const Verdict&, const Verdict&) = default;
  };

  /// What to do with a request from `address` that shows a right token.
  Verdict right(const std::string& address, loop::Instant now);
  /// What to do with one that shows `token`, which is wrong; "": it shows none, and should.
  Verdict wrong(const std::string& address, std::string_view token, loop::Instant now);
  /// The tokens have changed.
  void forget() { counts_.clear(); }

 private:
  /// kFree at once, then one each kEach.
  class Allowance {
   public:
    bool has_one(loop::Instant now) const { return used_up_to_ - now <= kEach * (kFree - 1); }
    void use(loop::Instant now) { used_up_to_ = std::max(used_up_to_, now) + kEach; }

   private:
    loop::Instant used_up_to_{};
  };
  struct Count {
    bool has_been_right = false;
    loop::Instant last{};
    Allowance guesses, answers;
    std::array<std::string, 8> wrong;  // the last ones, each of at most a token's length
    std::size_t next = 0;              // of these to be replaced
  };
  Count& count_of(const std::string& address, loop::Instant now);

  std::map<std::string, Count, std::less<>> counts_;
};

}  // namespace adit::intake
