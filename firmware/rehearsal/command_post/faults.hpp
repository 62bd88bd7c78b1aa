#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <expected>
#include <mutex>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rehearsal/command_post/fault.hpp"
#include "rehearsal/command_post/json.hpp"

namespace adit::rehearsal {

/// The requests that faults can be aimed at.
enum class Aim : std::uint8_t {
  Reports,  // POST /api/artifact_reports
  Status,   // GET /api/status
  Mapping,  // POST /map/update, /state/update, /markers/update
};
inline constexpr std::array<std::string_view, 3> kAims = {"reports", "status", "mapping"};

/// The faults that wait for their requests: a queue for each aim, and what happens at random where a queue is
/// empty. An error is a sentence that names what was not understood. Safe for use by several threads.
class Faults {
 public:
  static constexpr std::size_t kMost = 10'000;

  explicit Faults(std::uint64_t seed) : chance_(seed) {}

  using Told = std::expected<void, std::string>;

  /// "reports:record-then-drop": appended to that queue.
  Told tell(std::string_view aim_and_fault);
  /// "reports:record-then-drop=0.1": to one request of ten, on average.
  Told tell_rate(std::string_view aim_fault_and_rate);
  /// {"reports": ["record-then-drop", "ok"], "status": ["500"]}: appended, all of it or nothing.
  Told tell_all(const Json& told);

  /// From now on every request is answered as it should be.
  void clear();

  /// The fault for a request that has come; where there is none it behaves. Once a fault has said how wrong
  /// remaining_reports is to be, every later one for Status says so too.
  Fault next(Aim aim);

  /// What waits, what happens at random, and how wrong remaining_reports is.
  OrderedJson left() const;

 private:
  struct Rate {
    Aim aim;
    Fault fault;
    double rate;
  };
  using Aimed = std::pair<Aim, Fault>;

  static std::expected<Aimed, std::string> read_aimed(std::string_view text);
  Told append(const std::vector<Aimed>& aimed);
  Fault at_random(Aim aim);
  std::deque<Fault>& queue(Aim aim) { return queues_[static_cast<std::size_t>(aim)]; }

  mutable std::mutex mutex_;
  std::array<std::deque<Fault>, kAims.size()> queues_;
  std::vector<Rate> rates_;
  std::int64_t remaining_offset_ = 0;
  std::mt19937_64 chance_;
};

}  // namespace adit::rehearsal
