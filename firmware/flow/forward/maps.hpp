#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "dispatch/runs.hpp"
#include "forward/channel.hpp"
#include "forward/map_store.hpp"
#include "forward/rejected.hpp"
#include "forward/slot.hpp"
#include "forward/stitched.hpp"
#include "forward/traffic_counts.hpp"
#include "forward/uri_pace.hpp"
#include "journal/journal.hpp"
#include "loop/watchdog.hpp"
#include "pack/stitch.hpp"
#include "queues/map_queue.hpp"
#include "queues/stamps.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// Maps to the mapping endpoint. The writer stores a map before Adit accepts it. A worker packs one map while
/// another is sent. They go one at a time on a connection of their own, within the link's budget. If the
/// Command Post answers well, a map starts when the one before has arrived, without its answer
/// (queues::Pipelining). Two maps never share a second of the Command Post's limit.
///
/// Each of two maps in flight ends separately. A failed one returns to the queue, and no other starts before
/// both have ended. A 429 does not count for maps sent before it (pace::RateLimit). Stamps rise in the order
/// of sending.
class Maps {
 public:
  /// Each map has a mapped file (vm.max_map_count: 65,530). Beyond kMostMaps only merging maps are accepted.
  static constexpr std::size_t kMostMaps = 20'000, kMostWithJoined = 40'000;

  /// `taken` gets delivered maps. `spool` outlives the writer.
  Maps(loop::Loop& loop, uplink::Servers& servers, loop::Workers& workers, loop::Writer& writer,
       spool::Spool& spool, const settings::Settings& settings, std::optional<icd::BearerToken> token,
       TrafficCounts& counts, RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
       std::function<void(icd::MapUpdate)> taken);

  /// `ran_before`: this box may have sent maps before.
  void restore(const journal::HandoverState& carried, bool ran_before);
  void assume_just_sent() { pace_.on_sent(loop_.now()); }
  void on_settings_changed();
  /// Requests to another address or token are given up and retried at the new one.
  void on_endpoint_changed(std::optional<icd::BearerToken> token);
  /// A status confirms the present run.
  void on_status();
  /// Another run is on, so the Command Post may have another map.
  void change_run(dispatch::NextMap next);
  /// Queues the stored maps. Their data is checked when they are packed. A map whose packing ended
  /// Spool::EndCounts::kMost processes by a fault is put aside, with the rejected messages.
  void restore(spool::Spool::KeptMaps kept);

  /// With room for a grid that replaces one.
  std::shared_ptr<intake::MapArrival> begin_map(SpooledMapArrival::Accept take) {
    return store_.begin_map([this] { return queue_.largest_replaceable(); }, std::move(take));
  }
  /// Stamps are on the stamp clock. `file`: of its data, or null. `done`: stored and queued, 429 for a full
  /// queue, 503 if it cannot be stored. Of a grid that newer ones overtook, only the cells outside of them
  /// are queued; a whole cloud that was overtaken is not.
  void accept(icd::MapUpdate update, const queues::Upload& upload, std::shared_ptr<spool::MapFile> file,
              std::function<void(icd::Checked<void>)> done) {
    accept(std::make_shared<ReceivedMap>(
        ReceivedMap{std::move(update), upload, std::move(file), std::move(done)}));
  }

  /// Queues a rejected map before its sender's other maps. `done` is called with true if it is stored, or if
  /// a queued or sent map contains it. It returns false if such a map was accepted since; then it is not
  /// sent. `bounds`, `faults`: queues::RejectedMessage.
  void resend(icd::MapUpdate update, std::function<bool(bool kept)> done,
              const std::optional<icd::GridBounds>& bounds = {}, int faults = 0);

  /// Stops sending, and compares no more clouds. False while an answer is awaited.
  bool stop();
  void set_standby() { stopping_ = true; }
  bool has_stored_all() const { return overtaken_.empty() && store_.count() == 0; }
  /// Why the last map could not be stored, or "".
  const std::string& trouble() const { return store_.trouble(); }
  /// The cable is in again: retries at once.
  void on_link_up();

  bool packing() const { return is_packing_; }
  const Channel& channel() const { return channel_; }
  std::size_t queued_bytes() const { return queue_.bytes(); }
  std::size_t waiting(const Traffic& traffic) const;
  /// When the oldest map, queued or in flight, was accepted.
  std::optional<loop::Instant> oldest_acceptance(const Traffic& traffic) const;

 private:
  /// A whole map that is not queued yet.
  struct ReceivedMap {
    icd::MapUpdate update;
    queues::Upload upload;
    std::shared_ptr<spool::MapFile> file;
    std::function<void(icd::Checked<void>)> done;
    /// If newer grids overtook it: its cells outside of them, which are queued as grids of their own.
    std::vector<pack::Tile> tiles = {};
    icd::Checked<void> cut = {};
    std::vector<MapStore::StoredMap> parts = {};  // stored tiles
  };
  /// A map that was taken from the queue.
  struct PreparedMap {
    queues::QueuedMap waiting;
    queues::MapState state = queues::MapState::Queued;
    PackedMap packed{};                           // empty body: nothing to send
    std::vector<MapStore::DamagedMap> damaged{};  // cannot be sent
    loop::Duration packing_took{0};               // by the worker
    bool went_ahead = false;
    bool was_followed = false;  // the next map went ahead of its answer
    bool begins_again = false;  // a piece, in flight when the Command Post may have lost those before it
    loop::Instant last_byte_not_before{};
    std::optional<loop::Instant> arrived{};  // estimate
  };
  using Place = std::shared_ptr<PreparedMap>;

  void apply_settings();
  bool is_heard_from() const;
  void pump() noexcept;

  // Arrival: a map with room is queued once it is stored. A worker then finds clouds that newer ones contain.
  void accept(const std::shared_ptr<ReceivedMap>& map);
  bool has_room_for(const icd::MapUpdate& update, bool replaces) const;
  bool record_area(const icd::MapUpdate& update);
  void on_stored(MapStore::StoredMap& stored, ReceivedMap& map);
  void queue(MapStore::StoredMap& stored);
  void store_uncovered(const std::shared_ptr<ReceivedMap>& map, std::span<const icd::GridBounds> newer);
  void store_next_tile(const std::shared_ptr<ReceivedMap>& map);
  void accept(ReceivedMap& map);
  void refuse(ReceivedMap& map, icd::Refusal why) { end(map, std::unexpected(std::move(why))); }
  void end(ReceivedMap& map, const icd::Checked<void>& outcome);
  void restore(spool::Spool::KeptMap kept);
  void put_aside(spool::Spool::KeptMap kept);
  void finish_storing(MapStore::StoredMap& stored, queues::QueuedMap back,
                      const std::function<bool(bool kept)>& done);
  queues::QueuedMap requeued_map(std::uint64_t number, icd::MapUpdate update,
                                 const std::optional<icd::GridBounds>& bounds,
                                 const spool::Spool::EndCounts& ends) const;
  void set_cloud_kind(const icd::MapUpdate& update);
  void compare();
  void on_compared(const queues::CloudPair& two, bool has_all);

  // Packing: a worker packs one map at a time, the next one to send.
  void prepare(bool follows);
  void pack(const Place& prepared);
  void on_work_done(const Place& prepared);
  void on_work_failed(const Place& prepared);
  void step(Place map, queues::MapEvent event);
  void recall(const Place& map);
  void put_back_smaller(PreparedMap& map);
  void set_aside(const PreparedMap& map);
  std::vector<const PreparedMap*> prepared_of(const Traffic& traffic) const;
  std::optional<queues::ReplacedMaps> absorb(const queues::QueuedMap& back);
  void repack();

  // Sending, and the answers.
  void advance();
  loop::Instant start_time() const;
  loop::Instant packing_time(loop::Instant now) const;
  void pipeline_map(loop::Instant now);
  bool can_pipeline(loop::Instant now) const;
  void send(const Place& prepared);
  void on_answered(const Place& sent, const uplink::Outcome& outcome);
  void classify(const Place& sent, const uplink::Outcome& outcome);
  void on_verdict(const Place& sent, const uplink::Answered& answered);
  void on_accepted(const Place& sent, const uplink::Answered& answered);
  void on_too_large(const Place& sent, const uplink::Answered& answered, const std::string& sentence);
  bool must_split(const PreparedMap& prepared) const;
  bool is_cut_by_size(PreparedMap& sent);
  static bool can_be_overtaken(const PreparedMap& sent);
  void send_smaller(const Place& sent, std::size_t bytes, int status, const std::string& sentence);
  void retry(const Place& sent);
  void give_up(const Place& sent, int status, const std::string& sentence);

  loop::Loop& loop_;
  loop::Workers& workers_;
  const settings::Settings& settings_;
  TrafficCounts& counts_;
  RejectedStore& rejected_;
  journal::Journal& journal_;
  std::function<void(icd::MapUpdate)> taken_;
  Channel channel_;
  UriPace pace_;
  loop::Source wake_;

  queues::MapQueue queue_;
  MapStore store_;
  Slot slot_;
  queues::OvertakenMaps overtaken_;
  std::map<Traffic, icd::Stamp> behind_;               // journal::Heard::behind, until restore()
  std::vector<std::shared_ptr<ReceivedMap>> waiting_;  // for others that are being stored
  bool are_grids_told_ = true;                         // the journal has the areas of grids
  bool is_comparing_ = false;                          // a worker compares two clouds
  Place first_, following_;                            // the next map or the one in flight, and its follower
  bool is_packing_ = false;
  loop::JobWatch packing_;
  queues::Pipelining ahead_;
  queues::Blame blame_;
  bool stopping_ = false;
};

}  // namespace adit::forward
