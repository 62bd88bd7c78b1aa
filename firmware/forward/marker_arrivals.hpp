#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "forward/record.hpp"
#include "icd/markers_update.hpp"
#include "icd/status.hpp"
#include "journal/journal.hpp"
#include "lanes/marker_lane.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::forward {

/// Markers updates on their way into the lane, one after the other and each as a whole: first the journal has
/// it, then the lane. A worker makes the record of a large one, which goes into the lane over several turns
/// of the loop.
class MarkerArrivals {
 public:
  /// It is kept and waits; or 429 where the lane is full, 503 where it cannot be kept. Of markers for which
  /// there is no room, those that change one which waits are taken all the same; the refusal is about the
  /// others, and says how many they are.
  using Done = std::function<void(icd::Checked<void>)>;
  /// What is no larger is taken at once; as icd::bytes_of counts.
  static constexpr std::size_t kSmall = 128u << 10;
  static constexpr std::size_t kPart = 500;  // markers that go into the lane in one turn

  /// `came` is called when the lane has more than before.
  MarkerArrivals(loop::Loop& loop, loop::Workers& workers, journal::Journal& journal, lanes::MarkerLane& lane,
                 Record& record, std::function<void()> came);

  void take(icd::MarkersUpdate update, std::size_t bytes_received, Done done);

  /// Whether the journal has all of one and the lane not yet: nothing may be taken out of it meanwhile.
  bool is_in_part() const { return !empty() && arrivals_.front().is_kept; }
  bool empty() const { return arrivals_.empty(); }

 private:
  struct Arrival {
    std::shared_ptr<icd::MarkersUpdate> update;
    std::size_t bytes_received = 0;
    Done done;
    icd::Checked<void> outcome = {};
    std::string record = {};
    bool is_kept = false;                                                // by the journal
    std::size_t added = 0;                                               // of its markers, to the lane
    lanes::MarkerChanges::Place last = lanes::WaitingUpdates::kNowhere;  // of those
  };
  /// A step with the first of them: true where its outcome is known.
  using Step = bool (MarkerArrivals::*)(Arrival&);

  void go(Step step) noexcept;
  bool begin(Arrival& arrival);
  /// Where there is no room for it: whether some of it may be taken all the same.
  bool takes_some(Arrival& arrival);
  void make_record(const Arrival& arrival);
  bool keep(Arrival& arrival);
  bool add_part(Arrival& arrival);
  void free_needless();
  bool fail(Arrival& arrival, icd::Refusal why);
  void end();

  loop::Loop& loop_;
  loop::Workers& workers_;
  journal::Journal& journal_;
  lanes::MarkerLane& lane_;
  Record& record_;
  std::function<void()> came_;
  std::deque<Arrival> arrivals_;  // the first is being taken
  loop::Source next_turn_;
};

}  // namespace adit::forward
