#pragma once

#include <map>
#include <string>

#include "access/role.hpp"

namespace adit::access {

/// Slows down who guesses passwords: after kFree wrong ones from an address, or kFreeInAll from all, each
/// next try has to wait, 1 s at first and twice as long each time, up to a minute.
///
/// A try counts as wrong from its beginning, so that many at once are no way around; a right one is taken
/// back. What was long ago is forgotten.
class Failures {
 public:
  static constexpr int kFree = 5, kFreeInAll = 20;
  static constexpr std::chrono::seconds kFirst{1}, kMost{60};
  static constexpr std::chrono::minutes kForgotten{15};  // without another wrong one
  static constexpr std::size_t kMostAddresses = 256;     // at one more, the one that failed longest ago goes

  /// Zero: the password may be checked. Else how long to wait before it may; it is not to be checked now.
  Duration begin(const std::string& address, Instant now);
  /// The password of the last try was right. What others got wrong goes on counting: they may know one role's
  /// password and guess at the other's.
  void succeeded(const std::string& address);

 private:
  struct Count {
    int wrong = 0;
    Instant last{};
  };
  static Duration wait(const Count& count, int free, Instant now);
  void make_room(Instant now);

  std::map<std::string, Count> by_address_;
  Count all_;
};

}  // namespace adit::access
