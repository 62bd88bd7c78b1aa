#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "dispatch/run_watch.hpp"
#include "forward/channel.hpp"
#include "forward/map_arrival.hpp"
#include "forward/record.hpp"
#include "forward/rejected.hpp"
#include "forward/slot.hpp"
#include "forward/stitched.hpp"
#include "forward/taken_points.hpp"
#include "forward/uri_pace.hpp"
#include "icd/map_update.hpp"
#include "icd/status.hpp"
#include "loop/workers.hpp"
#include "queues/ahead.hpp"
#include "queues/map_queue.hpp"
#include "queues/stamps.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// Maps to the mapping endpoint. The writer stores a map before Adit accepts it. A worker packs one map while
/// another is sent. They go one at a time on a connection of their own, within the link's budget. If the
/// Command Post answers well, a map starts when the one before has arrived, without its answer
/// (queues::Ahead). Two maps never share a second of the Command Post's limit.
///
/// Each of two maps in flight ends separately. A failed one returns to the queue, and no other starts before
/// both have ended. A 429 does not count for maps sent before it (pace::RateLimit). Stamps rise in the order
/// of sending.
class Maps {
 public:
  /// Each map has a mapped file (vm.max_map_count is 65,530). Beyond kMostMaps only maps that merge with
  /// queued ones are accepted.
  static constexpr std::size_t kMostMaps = 20'000, kMostWithJoined = 40'000;
  /// Maps with lower numbers in the spool are sent again by the operator.
  static constexpr std::uint64_t kFirstNumber = 1u << 20;

  /// `taken` gets delivered maps. `spool` outlives the writer.
  Maps(loop::Loop& loop, loop::Workers& workers, loop::Writer& writer, spool::Spool& spool,
       const settings::Settings& settings, std::optional<icd::BearerToken> token, Record& record,
       RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
       std::function<void(icd::MapUpdate)> taken);

  /// `ran_before`: this box may have sent maps before.
  void carry_on(const journal::Carried& carried, bool ran_before);
  /// As if a map had just been sent.
  void hold_back() { pace_.sent(loop_.now()); }
  void settings_changed();
  /// Requests to another address or token are given up and retried at the new one.
  void endpoint_changed(std::optional<icd::BearerToken> token);
  /// A status confirms the present run.
  void heard();
  /// Another run is on, so the Command Post may have another map.
  void change_run(dispatch::NextMap next);
  /// Queues the stored maps. Their data is checked when they are packed.
  void restore(spool::Spool::Kept kept);

  std::shared_ptr<intake::MapArrival> arrives(MapArrival::Take take);
  /// Stamps are on the stamp clock. `file`: of its data, or null. `done`: stored and queued, 429 for a full
  /// queue, 503 if it cannot be stored.
  void take(icd::MapUpdate update, std::size_t bytes_received, std::shared_ptr<spool::MapFile> file,
            std::function<void(icd::Checked<void>)> done);

  /// Queues a rejected map before its sender's other maps. `done` is called with true if it is stored, or if
  /// a queued or sent map contains it. It returns false if such a map was accepted since; then it is not
  /// sent.
  void send_again(icd::MapUpdate update, std::function<bool(bool kept)> done);

  /// Stops sending. False while an answer is awaited.
  bool stop();
  void stand_by() { stopping_ = true; }
  /// True if no map is being stored.
  bool all_kept() const { return being_kept_ == 0; }
  /// Why the last map could not be stored, or "".
  const std::string& trouble() const { return trouble_; }
  /// The cable is in again: retries at once.
  void link_is_back();

  bool packing() const { return preparing_; }
  const Channel& channel() const { return channel_; }
  std::size_t queued_bytes() const { return queue_.bytes(); }
  std::size_t waiting(const Traffic& traffic) const;
  /// When the oldest map, queued or in flight, was accepted.
  std::optional<loop::Instant> waits_since(const Traffic& traffic) const;

 private:
  /// A map with damaged data.
  struct Damaged {
    std::uint64_t number = 0;
    std::string why;
  };
  struct Prepared {
    queues::QueuedMap waiting;
    Packed packed;                   // empty body: not packed, or nothing to send
    std::vector<Damaged> damaged;    // cannot be sent
    loop::Duration packing_took{0};  // by the worker
    bool is_under_way = false, went_ahead = false;
    loop::Instant last_byte_not_before{};
    std::optional<loop::Instant> arrived{};  // estimate
  };
  using Place = std::shared_ptr<Prepared>;

  std::vector<std::uint64_t> add(std::uint64_t number, icd::MapUpdate update);
  void restore(std::uint64_t number, icd::MapUpdate update);
  void tell_clouds(const icd::MapUpdate& update);  // kind of clouds by the settings
  void take_settings();
  void leads_elsewhere();
  void pack_again();
  bool is_heard_from() const;
  void carry_on_grids(const journal::Carried& carried, bool ran_before);
  bool is_told(const icd::MapUpdate& update);
  void compare();
  void compared(const queues::Successive& two, bool has_all);
  /// A map that is being stored. The writer owns it until then.
  struct Keeping {
    std::uint64_t number = 0;
    std::size_t bytes_received = 0, size = 0;
    std::uint64_t spare = 0;          // bytes to leave free
    std::optional<icd::Stamp> again;  // queues::QueuedMap::again
    bool says_nothing = false;        // no valid point: not stored
    icd::MapUpdate update;
    std::shared_ptr<spool::MapFile> file;  // with the data that arrived
    icd::Checked<icd::MapUpdate> kept;
  };
  bool has_room_for(const icd::MapUpdate& update, bool replaces) const;
  void keep(const std::shared_ptr<Keeping>& keeping, const std::function<void(Keeping&)>& told);
  void kept(Keeping& keeping, const std::function<void(icd::Checked<void>)>& done);
  void kept_again(Keeping& keeping, const std::function<bool(bool kept)>& done);
  std::vector<const Prepared*> prepared_of(const Traffic& traffic) const;
  bool is_said_by_what_goes(const queues::QueuedMap& back) const;
  queues::QueuedMap waiting_again(std::uint64_t number, icd::MapUpdate update, icd::Stamp again) const;
  std::uint64_t next_number(bool again);
  void forget(std::span<const std::uint64_t> numbers);
  void pump() noexcept;
  void go_on();
  loop::Instant starts() const;
  loop::Instant begins_to_pack(loop::Instant now) const;
  void prepare(Place& place);
  void pack(const Place& prepared);
  void not_packed(const Place& prepared);
  Place* place_of(const Place& prepared);
  void learn_from(const Prepared& prepared);
  void is_packed(const Place& prepared);
  std::vector<std::uint64_t> unread_in(const queues::QueuedMap& waiting) const;
  static std::vector<Damaged> damaged_in(const queues::QueuedMap& waiting,
                                         const std::vector<std::uint64_t>& unread);
  void is_damaged(Place& place);
  void is_there(Place& place);
  void goes_whole(const Place& sent, int status);
  void points_taken(Prepared& sent);
  void send(const Place& prepared);
  void go_ahead(loop::Instant now);
  bool may_go_ahead(loop::Instant now) const;
  void answered(const Place& sent, const uplink::Outcome& outcome);
  void classify(const Place& sent, const uplink::Outcome& outcome);
  void verdict(const Place& sent, const uplink::Answered& answered);
  void taken(const Place& sent, const uplink::Answered& answered);
  void leaves(const Place& sent);
  void again(const Place& sent);
  void put_back(Place& prepared);
  void give_up(const Place& sent, int status, const std::string& sentence);

  loop::Loop& loop_;
  loop::Workers& workers_;
  loop::Writer& writer_;
  const std::shared_ptr<loop::Writer> while_alive_;  // the same, for arrivals that outlive this
  spool::Spool& spool_;
  const settings::Settings& settings_;
  Record& record_;
  journal::Journal& journal_;
  RejectedStore& rejected_;
  std::function<void(icd::MapUpdate)> taken_;
  Channel channel_;
  UriPace pace_;
  loop::Source wake_;

  Slot slot_;
  queues::MapQueue queue_;
  queues::StampOrder stamps_;
  TakenPoints points_;
  std::uint64_t numbers_ = kFirstNumber, again_numbers_ = 0;
  int being_kept_ = 0;
  std::size_t bytes_being_kept_ = 0;
  std::string trouble_;
  bool preparing_ = false;
  bool comparing_ = false;  // a worker compares two clouds
  Place prepared_;          // packed, ready or in flight
  Place following_;         // next; may be in flight
  queues::Ahead ahead_;
  std::set<std::uint64_t> unread_;  // data not checked yet
  queues::Blame blame_;
  bool stopping_ = false;
  bool are_grids_told_ = true;  // the journal has the areas of grids
};

}  // namespace adit::forward
