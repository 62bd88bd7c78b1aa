#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "loop/loop.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

/// Of a fault: a report or a status that came too soon after the other.
inline constexpr const char* kBeyondOneLimit = "beyond one limit";

/// When a request left Adit: as if all bytes were as long on their way, for what the line adds is not Adit's.
struct WhenLeft {
  loop::Instant first, last;
};

/// A Command Post takes about one request a second of a URI, and may measure that from first byte to first
/// byte, from last byte to last byte, or from its answer to the next first byte. The seed draws which.
class Counting {
 public:
  enum class What : std::uint8_t { Starts, LastBytes, Answers };

  explicit Counting(Random random) : what_(static_cast<What>(random.below(3))) {}

  What what() const { return what_; }
  bool is_too_soon(const std::string& path, const WhenLeft& left) const;
  /// One that is not. May be called again, when its answer leaves.
  void count(const std::string& path, const WhenLeft& left, loop::Instant answered);

 private:
  What what_;
  std::map<std::string, loop::Instant> last_;
};

/// Of Fault, as `who`: a 429 for that; its serial is the What.
inline constexpr const char* kTooSoon = "too soon";

}  // namespace adit::simulation
