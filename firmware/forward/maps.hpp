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
#include "lanes/ahead.hpp"
#include "lanes/map_lane.hpp"
#include "lanes/stamps.hpp"
#include "loop/workers.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// Maps on their way to the mapping endpoint: are kept by the writer before they are taken, wait in their
/// lane, are packed on a worker, the next one while one is sent, and go out one at a time by a way of their
/// own, paced within the link's budget. Where the Command Post answers well, the next one goes ahead: it
/// begins once the one before has arrived, and its answer is still awaited (lanes::Ahead). So the link is not
/// idle meanwhile, and a second of the Command Post's is never shared by two.
///
/// Each of the two under way ends by itself: what fails goes back into the lane, where the other one stays
/// under way, and no new one is sent before that has ended as well. A 429 says nothing of what was sent
/// before it came (pace::RateLimit). Stamps go up in the order in which maps are sent.
class Maps {
 public:
  /// So many may wait, however small: each has a file that is mapped (vm.max_map_count is 65,530). Up to
  /// kMostWithJoined are taken where they join what waits of their robot and kind.
  static constexpr std::size_t kMostMaps = 20'000, kMostWithJoined = 40'000;
  /// In the spool those below are sent again by hand.
  static constexpr std::uint64_t kFirstNumber = 1u << 20;

  /// `taken` is given each map that the Command Post took. `spool` outlives the writer.
  Maps(loop::Loop& loop, loop::Workers& workers, loop::Writer& writer, spool::Spool& spool,
       const settings::Settings& settings, std::optional<icd::BearerToken> token, Record& record,
       RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
       std::function<void(icd::MapUpdate)> taken);

  /// `ran_before`: this box may have sent maps before.
  void carry_on(const journal::Carried& carried, bool ran_before);
  /// As if something had just been sent, by whoever sent before.
  void hold_back() { pace_.sent(loop_.now()); }
  /// The settings are others, by which it goes from now on.
  void settings_changed();
  /// The endpoint is, or its token, or the way there: what is under way to another place is given up, and
  /// sent again to this one.
  void endpoint_changed(std::optional<icd::BearerToken> token);
  /// A status shows that the present run is on.
  void heard();
  /// Another run is on: what the Command Post took of the one before it may have no more.
  void change_run(dispatch::NextMap next);
  /// The maps that the spool kept. A map's data is looked at when it is packed.
  void restore(spool::Spool::Kept kept);

  /// For a map that begins to arrive. What is stored of it goes to the writer until this ends.
  std::shared_ptr<intake::MapArrival> arrives(MapArrival::Take take);
  /// `update`'s stamp is on the gateway's clock; `file`: where its data was stored, or null. `done` is told
  /// once it is kept and waits, or why not: 429 where the queue is full and it replaces nothing, 503 where
  /// there is no room for it.
  void take(icd::MapUpdate update, std::size_t bytes_received, std::shared_ptr<spool::MapFile> file,
            std::function<void(icd::Checked<void>)> done);

  /// What was rejected, on the operator's word: before all that waits of its sender's. `done` is told
  /// whether it is kept; if not, nothing has become of it. It says whether it is still to go: nothing newer
  /// that says all of it was taken since.
  void send_again(icd::MapUpdate update, std::function<bool(bool kept)> done);

  /// Sends nothing more. False while an answer is awaited.
  bool stop();
  /// Sends nothing from the beginning.
  void stand_by() { stopping_ = true; }
  /// Whether nothing that was to be taken has still to be kept.
  bool all_kept() const { return being_kept_ == 0; }
  /// Why the last map could not be kept, or "".
  const std::string& trouble() const { return trouble_; }
  /// The cable is: nothing waits any more for what failed without it.
  void link_is_back();

  bool packing() const { return preparing_; }
  const Channel& channel() const { return channel_; }
  std::size_t queued_bytes() const { return lane_.bytes(); }
  std::size_t waiting(const Traffic& traffic) const;
  /// When the oldest news that waits or is under way was accepted; nothing if there is none.
  std::optional<loop::Instant> waits_since(const Traffic& traffic) const;

 private:
  /// A map whose data is not what it should be.
  struct Damaged {
    std::uint64_t number = 0;
    std::string why;
  };
  /// A map out of the lane, in the form that goes upstream.
  struct Prepared {
    lanes::WaitingMap waiting;
    Packed packed;                   // without a body: not packed, or nothing is left to be sent
    std::vector<Damaged> damaged;    // of it, which cannot be sent
    loop::Duration packing_took{0};  // the worker
    bool is_under_way = false, went_ahead = false;
    loop::Instant last_byte_not_before{};
    std::optional<loop::Instant> arrived{};  // about when, once that was seen
  };
  using Place = std::shared_ptr<Prepared>;

  std::vector<std::uint64_t> add(std::uint64_t number, icd::MapUpdate update);
  void restore(std::uint64_t number, icd::MapUpdate update);
  void tell_clouds(const icd::MapUpdate& update);  // what the settings say of its sender's
  void take_settings();
  void leads_elsewhere();
  void pack_again();
  bool is_heard_from() const;
  void carry_on_grids(const journal::Carried& carried, bool ran_before);
  bool is_told(const icd::MapUpdate& update);
  void compare();
  void compared(const lanes::Successive& two, bool has_all);
  /// A map on its way to its file: the writer's, until it is handed back.
  struct Keeping {
    std::uint64_t number = 0;
    std::size_t bytes_received = 0, size = 0;
    std::uint64_t spare = 0;          // that is to be left
    std::optional<icd::Stamp> again;  // lanes::WaitingMap's
    bool says_nothing = false;        // it has no valid point, and is not kept
    icd::MapUpdate update;
    std::shared_ptr<spool::MapFile> file;  // where its data was stored as it came
    icd::Checked<icd::MapUpdate> kept;
  };
  bool has_room_for(const icd::MapUpdate& update, bool replaces) const;
  void keep(const std::shared_ptr<Keeping>& keeping, const std::function<void(Keeping&)>& told);
  void kept(Keeping& keeping, const std::function<void(icd::Checked<void>)>& done);
  void kept_again(Keeping& keeping, const std::function<bool(bool kept)>& done);
  std::vector<const Prepared*> prepared_of(const Traffic& traffic) const;
  bool is_said_by_what_goes(const lanes::WaitingMap& back) const;
  lanes::WaitingMap waiting_again(std::uint64_t number, icd::MapUpdate update, icd::Stamp again) const;
  std::uint64_t next_number(bool again);
  void forget(std::span<const std::uint64_t> numbers);
  void pump() noexcept;
  void go_on();
  loop::Instant starts() const;
  loop::Instant begins_to_pack(loop::Instant now) const;
  void prepare(Place& place);
  bool is_awaited(const lanes::WaitingMap& waiting) const;
  Packing packing_for(const lanes::WaitingMap& waiting) const;
  void pack(const Place& prepared);
  void not_packed(const Place& prepared);
  Place* place_of(const Place& prepared);
  void learn_from(const Prepared& prepared);
  void is_packed(const Place& prepared);
  std::vector<std::uint64_t> unread_in(const lanes::WaitingMap& waiting) const;
  static std::vector<Damaged> damaged_in(const lanes::WaitingMap& waiting,
                                         const std::vector<std::uint64_t>& unread);
  void is_damaged(Place& place);
  void is_there(Place& place);
  void goes_whole(const Place& sent, int status);
  void points_taken(Prepared& sent);
  void send(const Place& prepared);
  void go_ahead(loop::Instant now);
  bool may_go_ahead(loop::Instant now) const;
  void answered(const Place& sent, const uplink::Outcome& outcome);
  void judge(const Place& sent, const uplink::Outcome& outcome);
  void verdict(const Place& sent, const uplink::Answered& answered);
  void taken(const Place& sent, const uplink::Answered& answered);
  void leaves(const Place& sent);
  void again(const Place& sent);
  void put_back(Place& prepared);
  void give_up(const Place& sent, int status, const std::string& sentence);

  loop::Loop& loop_;
  loop::Workers& workers_;
  loop::Writer& writer_;
  const std::shared_ptr<loop::Writer> while_alive_;  // the same, for arrivals, which may outlive this
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
  lanes::MapLane lane_;
  lanes::StampOrder stamps_;
  TakenPoints points_;
  std::uint64_t numbers_ = kFirstNumber, again_numbers_ = 0;
  int being_kept_ = 0;
  std::size_t bytes_being_kept_ = 0;
  std::string trouble_;
  bool preparing_ = false;
  bool comparing_ = false;  // a worker is comparing two clouds
  Place prepared_;          // while it is packed, waits for its time, or is under way
  Place following_;         // the next one, while that is under way; may be so itself, too
  lanes::Ahead ahead_;
  std::set<std::uint64_t> unread_;  // numbers of maps whose data is still to be checked
  lanes::Blame blame_;
  bool stopping_ = false;
  bool are_grids_told_ = true;  // the journal has where grids are posted
};

}  // namespace adit::forward
