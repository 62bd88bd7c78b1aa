#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "intake/message_handler.hpp"
#include "loop/workers.hpp"
#include "queues/map_queue.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// A map that is stored in the spool as it arrives. Until it is accepted, it leaves its own size and `spare`
/// bytes free. Data without room stays in memory until the map is complete, because a grid may compress to a
/// tenth. On the loop, except stored_bytes().
class SpooledMapArrival final : public intake::MapArrival {
 public:
  /// Accepts the complete map with its file; null if it has none.
  using Accept =
      std::function<void(icd::MapUpdate update, const intake::Sender& sender,
                         std::shared_ptr<spool::MapFile> file, std::function<void(icd::Checked<void>)> done)>;

  /// `writer` and `spool` live while `writer` can be locked.
  SpooledMapArrival(std::weak_ptr<loop::Writer> writer, spool::Spool& spool,
                    std::function<std::uint64_t()> spare, Accept take);
  ~SpooledMapArrival() override;
  SpooledMapArrival(const SpooledMapArrival&) = delete;
  SpooledMapArrival& operator=(const SpooledMapArrival&) = delete;

  void store(icd::ChunkedBytes bytes, std::function<void(icd::ChunkedBytes left)> done) override;
  icd::Checked<icd::ChunkedBytes> stored_bytes() override;
  void accept(icd::MapUpdate update, const intake::Sender& sender,
              std::function<void(icd::Checked<void>)> done) override;

 private:
  /// The writer's while it works on it.
  struct WriterFile {
    std::shared_ptr<spool::MapFile> file;  // null: none
  };

  std::weak_ptr<loop::Writer> writer_;
  spool::Spool& spool_;
  std::function<std::uint64_t()> spare_;
  Accept take_;
  std::shared_ptr<WriterFile> stored_ = std::make_shared<WriterFile>();
};

/// Maps in the spool, stored before Adit accepts them, until delivered, replaced or rejected. On the loop.
class MapStore {
 public:
  /// Maps with lower numbers are sent again by the operator. They are older than all others.
  static constexpr std::uint64_t kFirstNumber = 1u << 20;

  struct StoredMap {
    std::uint64_t number = 0;
    bool has_no_valid_point = false;   // `map` has no data and no file
    icd::Checked<icd::MapUpdate> map;  // with its data in the file; or why it could not be stored
  };
  /// A map with damaged data.
  struct DamagedMap {
    std::uint64_t number = 0;
    std::string why;
  };

  /// `spool` outlives the writer.
  MapStore(loop::Writer& writer, spool::Spool& spool);

  /// `spare`: bytes to leave free. The arrival may outlive this.
  std::shared_ptr<intake::MapArrival> begin_map(std::function<std::uint64_t()> spare,
                                                SpooledMapArrival::Accept take);
  /// Stores `update` and leaves `spare` bytes free. `file`: with its data, or null. `again`: the operator
  /// sends it again, with these bounds (QueuedMap::bounds).
  void store(icd::MapUpdate update, std::shared_ptr<spool::MapFile> file, std::uint64_t spare, bool again,
             std::function<void(StoredMap& stored)> done, std::optional<icd::GridBounds> bounds = {});
  /// Closes the file of a map that is not accepted; null: none.
  void discard(std::shared_ptr<spool::MapFile> file);
  void forget(std::span<const std::uint64_t> numbers);
  /// Deletes replaced maps once the newer one's bounds are stored, or else once the newer one is delivered.
  void forget(queues::ReplacedMaps replaced);
  /// Renames the damaged files.
  void set_aside(std::vector<DamagedMap> damaged);

  /// An earlier process stored map `number`: its data is unchecked. True: the operator sends it again.
  bool adopt(std::uint64_t number);
  /// Has the data checked by the next work on the map.
  void mark_unchecked(std::uint64_t number) { unchecked_.insert(number); }
  /// The number of the next map that the operator sends again.
  std::uint64_t next_resend_number() const { return again_numbers_ + 1; }
  /// A worker begins to pack `waiting`. Returns its unchecked maps.
  std::vector<std::uint64_t> begin_work(const queues::QueuedMap& waiting);
  /// `are_packed`: the maps are packed, and the data of `checked` is good.
  void end_work(bool are_packed, std::span<const std::uint64_t> checked);
  void record_overrun() { spool_.record_overrun(); }
  std::string work_file() const { return spool_.work_file(); }
  /// Faults ended aditd while it packed this map under another number.
  void remember(std::uint64_t number, const spool::Spool::EndCounts& ends) { spool_.remember(number, ends); }

  /// Maps that are being stored, and their bytes.
  std::size_t count() const { return count_; }
  std::size_t bytes() const { return bytes_; }
  /// Why the last map could not be stored, or "".
  const std::string& trouble() const { return trouble_; }
  void read_trouble() { trouble_ = spool_.trouble(); }

 private:
  loop::Writer& writer_;
  const std::shared_ptr<loop::Writer> while_alive_;  // the same, for arrivals that outlive this
  spool::Spool& spool_;
  std::uint64_t numbers_ = kFirstNumber, again_numbers_ = 0;
  std::size_t count_ = 0, bytes_ = 0;
  std::string trouble_;
  std::set<std::uint64_t> unchecked_;
};

icd::Refusal storage_refusal();

}  // namespace adit::forward
