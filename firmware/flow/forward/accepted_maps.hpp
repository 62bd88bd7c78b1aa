#pragma once

#include "forward/map_store.hpp"
#include "forward/prepared_maps.hpp"
#include "forward/traffic_counts.hpp"
#include "journal/journal.hpp"
#include "pack/stitch.hpp"
#include "queues/map_queue.hpp"
#include "queues/stamps.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// Accepts maps: decides whether there is room for a map, and queues it once it is stored. A worker then
/// finds queued clouds that newer ones contain.
class AcceptedMaps {
 public:
  /// Each map has a mapped file (vm.max_map_count is 65,530). Beyond kMostMaps only maps that merge with
  /// queued ones are accepted.
  static constexpr std::size_t kMostMaps = 20'000, kMostWithJoined = 40'000;

  /// `queued`: called after each change of `queue`. All outlive this.
  AcceptedMaps(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings,
               TrafficCounts& counts, journal::Journal& journal, queues::MapQueue& queue, MapStore& store,
               PreparedMaps& prepared, std::function<void()> queued)
      : loop_(loop),
        workers_(workers),
        settings_(settings),
        counts_(counts),
        journal_(journal),
        queue_(queue),
        store_(store),
        prepared_(prepared),
        queued_(std::move(queued)) {}

  /// Maps::carry_on(), restore(), take() and send_again().
  void carry_on(const journal::Carried& carried, bool ran_before);
  void restore(spool::Spool::Kept kept);
  void take(icd::MapUpdate update, const queues::Upload& upload, std::shared_ptr<spool::MapFile> file,
            std::function<void(icd::Checked<void>)> done) {
    take(std::make_shared<Arrived>(Arrived{std::move(update), upload, std::move(file), std::move(done)}));
  }
  void send_again(icd::MapUpdate update, std::function<bool(bool kept)> done,
                  const std::optional<icd::GridBounds>& bounds, int faults);
  /// Compares no more clouds.
  void stop() { stopping_ = true; }
  /// True if no map is being stored.
  bool all_kept() const { return overtaken_.empty() && store_.count() == 0; }

 private:
  using Ends = spool::Spool::Ends;

  void restore(spool::Spool::KeptMap kept);
  bool has_room_for(const icd::MapUpdate& update, bool replaces) const;
  bool is_told(const icd::MapUpdate& update);
  /// A whole map that is not queued yet.
  struct Arrived {
    icd::MapUpdate update;
    queues::Upload upload;
    std::shared_ptr<spool::MapFile> file;
    std::function<void(icd::Checked<void>)> done;
    /// If newer grids overtook it: its cells outside of them, which are queued as grids of their own.
    std::vector<pack::Tile> tiles = {};
    icd::Checked<void> cut = {};
    std::vector<MapStore::Stored> parts = {};  // stored tiles
  };
  void take(const std::shared_ptr<Arrived>& map);
  void stored(MapStore::Stored& stored, Arrived& map);
  void queue(MapStore::Stored& stored);
  void leave_out(const std::shared_ptr<Arrived>& map, std::span<const icd::GridBounds> newer);
  void store_next_tile(const std::shared_ptr<Arrived>& map);
  void accept(Arrived& map);
  void refuse(Arrived& map, icd::Refusal why);
  void end(Arrived& map, const icd::Checked<void>& outcome);
  void stored_again(MapStore::Stored& stored, queues::QueuedMap back,
                    const std::function<bool(bool kept)>& done);
  void tell_clouds(const icd::MapUpdate& update);  // kind of clouds by the settings
  queues::QueuedMap waiting_again(std::uint64_t number, icd::MapUpdate update,
                                  const std::optional<icd::GridBounds>& bounds, const Ends& ends) const;
  void compare();
  void compared(const queues::Successive& two, bool has_all);

  loop::Loop& loop_;
  loop::Workers& workers_;
  const settings::Settings& settings_;
  TrafficCounts& counts_;
  journal::Journal& journal_;
  queues::MapQueue& queue_;
  queues::OvertakenMaps overtaken_;
  std::vector<std::shared_ptr<Arrived>> waiting_;  // for others that are being stored
  MapStore& store_;
  PreparedMaps& prepared_;
  std::function<void()> queued_;
  bool are_grids_told_ = true;  // the journal has the areas of grids
  bool comparing_ = false;      // a worker compares two clouds
  bool stopping_ = false;
};

}  // namespace adit::forward
