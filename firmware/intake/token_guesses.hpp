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
/// Of an address kFree wrong tokens are looked at and answered at once, then one each kEach. The same wrong
/// one again tells its sender nothing new, so it is no guess, but its answer comes late: a robot with an old
/// token takes no guesses from those behind the same router. A right token is always let in, from everywhere
/// but where more was guessed than may be, by an address that has never shown a right one: there it is not
/// looked at, for otherwise each answer would tell whether a guess was right.
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

  /// What becomes of a request from `address` that shows a token which is right.
  Verdict right(const std::string& address, loop::Instant now);
  /// And of one that shows `token`, which is wrong, or none where one is asked for ("").
  Verdict wrong(const std::string& address, std::string_view token, loop::Instant now);
  /// What is right is another now.
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
