#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "access/role.hpp"

namespace adit::access {

/// Who tries a password.
struct Guesser {
  std::string address;
  std::uint64_t device = 0;  // Device::number; 0: a browser that has not been in before
  bool at_box = false;       // somebody pressed the box's button just now
};

/// How long before a password may be tried.
struct Wait {
  Duration left{};          // zero: now
  bool for_others = false;  // it is a turn among others, not a pause after wrong ones of his own

  friend bool operator==(const Wait&, const Wait&) = default;
};

/// Slows down who guesses passwords, and keeps who knows one from being shut out by those who guess.
///
/// After kFree wrong ones from an address or a device, each next try of its has to wait, 1 s at first and
/// twice as long each time, up to a minute. All together have one try each kEach: addresses get their turns
/// in the order in which they asked, and each has one at most. A known device needs no turn; neither does an
/// address that has not been wrong yet, while somebody is at the box.
///
/// A try counts as wrong from its beginning, so that many at once are no way around; a right one is taken
/// back. What was long ago is forgotten.
class Guesses {
 public:
  static constexpr int kFree = 5;
  static constexpr std::chrono::seconds kFirst{1}, kMost{60};
  static constexpr std::chrono::seconds kEach{1};
  static constexpr int kSaved = 5;                       // tries that a pause saves up for all
  static constexpr std::chrono::seconds kLate{10};       // for how long a turn is kept
  static constexpr std::chrono::minutes kForgotten{15};  // without another try
  static constexpr std::size_t kMostGuessers = 256;      // so no turn is further away than as many seconds

  /// Zero: the password may be checked. Else how long to wait before it may; it is not to be checked now.
  Wait begin(const Guesser& guesser, Instant now);
  /// The password of the last try was that of `role`. The operator's forgives what was wrong before; the
  /// viewers' does not, for who knows it may guess at the other.
  void succeeded(const Guesser& guesser, Role role);

 private:
  using Key =
      std::pair<std::uint64_t, std::string>;  // of a device the number alone, of an address that alone
  struct Count {
    int wrong = 0;
    Instant last{}, asked{};
    std::optional<Instant> turn;
  };
  static Key key_of(const Guesser& guesser);
  static Duration pause(const Count& count, Instant now);
  Count* count_of(const Guesser& guesser, Instant now);
  Duration turn(Count& own, Instant now);

  std::map<Key, Count> counts_;
  Instant next_{};  // when the next try of all may be
};

}  // namespace adit::access
