#pragma once

#include <memory>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/worker_upload.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

struct MapUploadOptions {
  codec::BodyKind kind;
  icd::Rules rules;
  std::size_t most_bytes = 0;                  // of the body
  std::shared_ptr<UploadBudget> without_room;  // for what is held because it cannot be stored
};

/// Takes a map. Its body is decoded on a worker as it arrives, one piece of work at a time; while more than
/// kPending waits for the worker, the client is made to wait. What has been decoded of its data is stored
/// kStored bytes and more at a time, and the worker rests while as much is decoded again before that is done:
/// a large map is nowhere in memory as a whole.
///
/// A body that is compressed as a whole may grow a thousandfold, and is decoded by little more than kStored
/// at a time. What it has grown to counts in the budget. Where it cannot be stored it is held until it can be
/// judged, kWithoutRoom of all such together; what is more is refused.
///
/// Once whole and checked it is the desk's, which answers when it is kept, also where the client has hung up
/// meanwhile; until then a client that hangs up takes its map back.
class MapUpload final : public WorkerUpload {
 public:
  static constexpr std::size_t kPending = 256 * 1024, kStored = 256 * 1024;
  static constexpr std::size_t kWithoutRoom = 24u << 20;

  MapUpload(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
            std::shared_ptr<UploadBudget> budget, std::shared_ptr<UnderWay> under_way);

 private:
  class State;
};

}  // namespace adit::intake
