#pragma once

#include <functional>
#include <memory>

#include "intake/desk.hpp"
#include "loop/workers.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// A map whose data the writer puts into the spool as it arrives. Until it is known whether the map will be
/// taken, it leaves as much room there for others as it takes itself, and `spare` more. Data without room is
/// held in memory until the map is complete and can be judged: it may be a grid that compresses to a tenth.
/// To be called on the loop, except stored().
class MapArrival final : public intake::MapArrival {
 public:
  /// What takes it when it is whole, with its file; null: nothing was stored.
  using Take =
      std::function<void(icd::MapUpdate update, const intake::Sender& sender,
                         std::shared_ptr<spool::MapFile> file, std::function<void(icd::Checked<void>)> done)>;

  /// `spare`: of bytes. `writer` and `spool` live as long as `writer`
  /// can be locked.
  MapArrival(std::weak_ptr<loop::Writer> writer, spool::Spool& spool, std::function<std::uint64_t()> spare,
             Take take);
  ~MapArrival() override;
  MapArrival(const MapArrival&) = delete;
  MapArrival& operator=(const MapArrival&) = delete;

  void store(icd::ChunkedBytes bytes, std::function<void(icd::ChunkedBytes left)> done) override;
  icd::Checked<icd::ChunkedBytes> stored() override;
  void take(icd::MapUpdate update, const intake::Sender& sender,
            std::function<void(icd::Checked<void>)> done) override;

 private:
  /// The writer's; anybody's while the writer does not work on it.
  struct Stored {
    std::shared_ptr<spool::MapFile> file;  // null: nothing is stored
  };

  std::weak_ptr<loop::Writer> writer_;
  spool::Spool& spool_;
  std::function<std::uint64_t()> spare_;
  Take take_;
  std::shared_ptr<Stored> stored_ = std::make_shared<Stored>();
};

}  // namespace adit::forward
