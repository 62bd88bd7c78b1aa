#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "loop/loop.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

/// Text of the fault: a report or a status came too soon after the other.
inline constexpr const char* kBeyondOneLimit = "beyond one limit";

/// When a request left Adit, as if all bytes took equally long: delays of the line are not Adit's fault.
struct WhenLeft {
  loop::Instant first, last;
};

/// The rate limit of a Command Post: about one request per second for each URI. It measures from first byte
/// to first byte, from last byte to last byte, or from its answer to the next first byte. The seed decides
/// which.
class Counting {
 public:
  enum class What : std::uint8_t { Starts, LastBytes, Answers };

  explicit Counting(Random random) : what_(static_cast<What>(random.uniform_index(3))) {}

  What what() const { return what_; }
  bool is_too_soon(const std::string& path, const WhenLeft& left) const;
  /// Counts an accepted request. May be called again when its answer leaves.
  void count(const std::string& path, const WhenLeft& left, loop::Instant answered);

 private:
  What what_;
  std::map<std::string, loop::Instant> last_;
};

/// Event::who of the fault for such a 429; the serial is the What.
inline constexpr const char* kTooSoon = "too soon";

}  // namespace adit::simulation
