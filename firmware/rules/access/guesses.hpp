#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "access/role.hpp"

namespace adit::access {

/// A client that tries a password.
struct Guesser {
  std::string address;
  std::uint64_t device = 0;  // Device::number; 0: not a known device
  bool at_box = false;       // the box's button was pressed within the last minute
};

/// How long a client must wait before its next try.
struct Wait {
  Duration left{};          // zero: it may try now
  bool for_others = false;  // it waits for its turn among other clients, not because its tries were wrong

  friend bool operator==(const Wait&, const Wait&) = default;
};

/// Slows down clients that guess passwords, without shutting out a client that knows one.
///
/// After kFree wrong tries by an address or a device, each further try must wait: first 1 s, then twice as
/// long each time, up to a minute. All clients together may try once in kEach. Each address has at most one
/// turn, in the order in which they asked. A known device needs no turn. An address without a wrong try needs
/// none while a person is at the box.
///
/// A try counts as wrong when it begins, so that parallel tries gain nothing. on_succeeded() takes that back.
/// A client is forgotten kForgotten after its last request.
class Guesses {
 public:
  static constexpr int kFree = 5;
  static constexpr std::chrono::seconds kFirst{1}, kMost{60};
  static constexpr std::chrono::seconds kEach{1};
  static constexpr int kSaved = 5;                       // a pause saves up this many tries for all clients
  static constexpr std::chrono::seconds kLate{10};       // a turn expires this long after it came
  static constexpr std::chrono::minutes kForgotten{15};  // without another try
  static constexpr std::size_t kMostGuessers = 256;      // so a turn comes within about as many seconds

  /// Zero: check the password now. Otherwise, do not check it; the client may try again after this wait.
  Wait begin(const Guesser& guesser, Instant now);
  /// The password of the last try was that of `role`. The operator's password clears the wrong tries. The
  /// viewers' password takes back one, because a viewer may be guessing the operator's.
  void on_succeeded(const Guesser& guesser, Role role);

 private:
  using Key =
      std::pair<std::uint64_t, std::string>;  // of a device only the number, of an address only the address
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
  Instant next_{};  // when the next try of any client is due
};

}  // namespace adit::access
