#pragma once

#include <functional>
#include <memory>

#include "intake/desk.hpp"
#include "loop/workers.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// A map that is stored in the spool as it arrives. Until it is accepted, it leaves its own size and `spare`
/// bytes free. Data without room stays in memory until the map is complete, because a grid may compress to a
/// tenth. On the loop, except stored().
class MapArrival final : public intake::MapArrival {
 public:
  /// Accepts the complete map with its file; null if it has none.
  using Take =
      std::function<void(icd::MapUpdate update, const intake::Sender& sender,
                         std::shared_ptr<spool::MapFile> file, std::function<void(icd::Checked<void>)> done)>;

  /// `writer` and `spool` live while `writer` can be locked.
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
  /// The writer's while it works on it.
  struct Stored {
    std::shared_ptr<spool::MapFile> file;  // null: none
  };

  std::weak_ptr<loop::Writer> writer_;
  spool::Spool& spool_;
  std::function<std::uint64_t()> spare_;
  Take take_;
  std::shared_ptr<Stored> stored_ = std::make_shared<Stored>();
};

}  // namespace adit::forward
