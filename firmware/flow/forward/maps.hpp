#pragma once

#include <optional>
#include <random>
#include <string>

#include "dispatch/runs.hpp"
#include "forward/accepted_maps.hpp"
#include "forward/channel.hpp"
#include "forward/prepared_maps.hpp"
#include "forward/rejected.hpp"
#include "forward/uri_pace.hpp"
#include "queues/map_queue.hpp"

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
  /// `taken` gets delivered maps. `spool` outlives the writer.
  Maps(loop::Loop& loop, uplink::Servers& servers, loop::Workers& workers, loop::Writer& writer,
       spool::Spool& spool, const settings::Settings& settings, std::optional<icd::BearerToken> token,
       TrafficCounts& counts, RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
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
  /// Queues the stored maps. Their data is checked when they are packed. A map whose packing ended
  /// Spool::Ends::kMost processes by a fault is put aside, with the rejected messages.
  void restore(spool::Spool::Kept kept);

  /// With room for a grid that replaces one.
  std::shared_ptr<intake::MapArrival> arrives(MapArrival::Take take) {
    return store_.arrives([this] { return queue_.largest_replaceable(); }, std::move(take));
  }
  /// Stamps are on the stamp clock. `file`: of its data, or null. `done`: stored and queued, 429 for a full
  /// queue, 503 if it cannot be stored. Of a grid that newer ones overtook, only the cells outside of them
  /// are queued; a whole cloud that was overtaken is not.
  void take(icd::MapUpdate update, const queues::Upload& upload, std::shared_ptr<spool::MapFile> file,
            std::function<void(icd::Checked<void>)> done) {
    accepted_.take(std::move(update), upload, std::move(file), std::move(done));
  }

  /// Queues a rejected map before its sender's other maps. `done` is called with true if it is stored, or if
  /// a queued or sent map contains it. It returns false if such a map was accepted since; then it is not
  /// sent. `bounds`, `faults`: queues::RejectedMessage.
  void send_again(icd::MapUpdate update, std::function<bool(bool kept)> done,
                  const std::optional<icd::GridBounds>& bounds = {}, int faults = 0) {
    accepted_.send_again(std::move(update), std::move(done), bounds, faults);
  }

  /// Stops sending. False while an answer is awaited.
  bool stop();
  void stand_by() {
    stopping_ = true;
    accepted_.stop();
  }
  /// True if no map is being stored.
  bool all_kept() const { return accepted_.all_kept(); }
  /// Why the last map could not be stored, or "".
  const std::string& trouble() const { return store_.trouble(); }
  /// The cable is in again: retries at once.
  void link_is_back();

  bool packing() const { return prepared_.is_packing(); }
  const Channel& channel() const { return channel_; }
  std::size_t queued_bytes() const { return queue_.bytes(); }
  std::size_t waiting(const Traffic& traffic) const;
  /// When the oldest map, queued or in flight, was accepted.
  std::optional<loop::Instant> waits_since(const Traffic& traffic) const;

 private:
  using Place = PreparedMaps::Place;

  void take_settings();
  bool is_heard_from() const;
  void pump() noexcept;
  void go_on();
  void packed(bool is_done);
  loop::Instant starts() const;
  loop::Instant begins_to_pack(loop::Instant now) const;
  void send(const Place& prepared);
  void go_ahead(loop::Instant now);
  bool may_go_ahead(loop::Instant now) const;
  void answered(const Place& sent, const uplink::Outcome& outcome);
  void classify(const Place& sent, const uplink::Outcome& outcome);
  void verdict(const Place& sent, const uplink::Answered& answered);
  void taken(const Place& sent, const uplink::Answered& answered);
  void on_too_large(const Place& sent, const uplink::Answered& answered, const std::string& sentence);
  bool must_split(const PreparedMap& prepared) const;
  bool is_cut_by_size(PreparedMap& sent);
  void send_smaller(const Place& sent, std::size_t bytes, int status, const std::string& sentence);
  void split(const Place& place);
  void again(const Place& sent);
  void give_up(const Place& sent, int status, const std::string& sentence);
  void put_aside(spool::Spool::KeptMap kept);

  loop::Loop& loop_;
  const settings::Settings& settings_;
  TrafficCounts& counts_;
  RejectedStore& rejected_;
  std::function<void(icd::MapUpdate)> taken_;
  Channel channel_;
  UriPace pace_;
  loop::Source wake_;

  queues::MapQueue queue_;
  MapStore store_;
  PreparedMaps prepared_;
  AcceptedMaps accepted_;
  queues::Pipelining ahead_;
  queues::Blame blame_;
  bool stopping_ = false;
};

}  // namespace adit::forward
