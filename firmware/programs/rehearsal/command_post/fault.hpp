#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <expected>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {

/// What a fault does to an answer (README.md, 'Rehearse with a bad Command Post').
struct Effect;

/// A fault of one request's answer, on purpose: at most one effect, and additions that go with any.
struct Fault {
  using Seconds = std::chrono::duration<double>;

  const Effect* effect = nullptr;    // null: none
  int times = 1;                     // that many requests, one after the other (429=COUNT)
  std::optional<Seconds> lasts;      // from its first request on, all those of its aim
  std::optional<std::string> robot;  // of whose messages alone; absent: of all
  bool other_sender = false;
  std::optional<std::int64_t> remaining;  // added to remaining_reports, from then on
  std::optional<Seconds> record_after;
  std::optional<Seconds> answer_after;
  std::optional<int> retry_after;  // seconds, in a header of the answer
  bool clock_stands = false;       // run_clock is what the measured server always says
};

/// The words again, in one order; kOk if there is nothing wrong.
std::string words_of(const Fault& fault);
inline constexpr std::string_view kOk = "ok";

/// The requests that faults can be aimed at.
enum class Aim : std::uint8_t {
  Reports,  // POST /api/artifact_reports
  Status,   // GET /api/status
  Mapping,  // POST /map/update, /state/update, /markers/update
};
inline constexpr std::array<std::string_view, 3> kAims = {"reports", "status", "mapping"};

/// The faults of one order, and whether the clocks stand from then on.
struct Orders {
  std::vector<std::pair<Aim, Fault>> aimed;
  std::optional<bool> clocks_stand;
};

using OrderResult = std::expected<void, std::string>;

/// The faults that wait for their requests: a queue for each aim, and random faults if a queue is empty. Also
/// whether the run's clocks stand, which is given like a fault and applies to all requests. An error is a
/// sentence that names the unknown word. Safe for use by several threads.
class Faults {
 public:
  static constexpr std::size_t kMost = 10'000;

  explicit Faults(std::uint64_t seed) : chance_(seed) {}

  /// "reports:record-then-drop": appended to that queue. "clock:constant", "clock:running": from now on.
  OrderResult add_order(std::string_view aim_and_fault);
  /// "reports:record-then-drop=0.1": to one request of ten, on average. "reports:429=3=0.1" begins at one of
  /// ten that find no fault waiting, "mapping:500,robot=ugv1=0.1" happens to one of ten of that robot's.
  OrderResult add_rate(std::string_view aim_fault_and_rate);
  /// {"reports": ["record-then-drop", "ok"], "status": ["500"]}: appended, all or not at all.
  OrderResult add_orders(const Json& told);

  /// From now on every request is answered as it should be.
  void clear();

  /// The fault for a request with `body`; one that behaves if none waits, or if `body` does not name the next
  /// fault's robot. After a fault with a wrong remaining_reports, each later one for Status has it; while the
  /// clocks stand, so has each one for Status and Reports.
  Fault next(Aim aim, std::string_view body, Clock::time_point now);

  /// The waiting faults, the random ones, the error of remaining_reports, and whether the clocks run.
  OrderedJson remaining() const;

 private:
  struct Rate {
    Aim aim;
    Fault fault;
    double rate;
  };

  OrderResult obey(const Orders& orders);
  std::optional<Fault> from_queue(Aim aim, std::string_view body, Clock::time_point now);
  Fault random_fault(Aim aim, std::string_view body, Clock::time_point now);
  std::deque<Fault>& queue(Aim aim) { return queues_[static_cast<std::size_t>(aim)]; }

  mutable std::mutex mutex_;
  std::array<std::deque<Fault>, kAims.size()> queues_;
  std::array<std::optional<Clock::time_point>, kAims.size()> until_;  // of the first in each queue
  std::vector<Rate> rates_;
  std::int64_t remaining_offset_ = 0;
  bool clocks_stand_ = false;
  std::mt19937_64 chance_;
};

/// Whether the request is judged at all.
bool records(const Fault& fault);

/// Puts the fault between a decided outcome and the connection. A judged outcome that is no answer stays.
void spoil(const Fault& fault, Aim aim, Manner manner, Judgement& judgement);

}  // namespace adit::rehearsal
