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
  std::size_t most_bytes = 0;  // of the body
};

/// Takes a map. Its body is decoded on a worker as it arrives, one piece of work at a time; while more than
/// kPending waits for the worker, the client is made to wait. What has been decoded of its data is stored
/// kStored bytes and more at a time, and the worker rests while as much is decoded again before that is done:
/// a large map is nowhere in memory as a whole.
///
/// A body that is compressed as a whole may grow a thousandfold. It is held as it came until it is whole, so
/// that the budget knows what is held, and no more than one for each worker is ever inflated.
///
/// Once whole and checked it is the desk's, which answers when it is kept, also where the client has hung up
/// meanwhile; until then a client that hangs up takes its map back.
class MapUpload final : public WorkerUpload {
 public:
  static constexpr std::size_t kPending = 256 * 1024, kStored = 256 * 1024;

  MapUpload(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
            std::shared_ptr<UploadBudget> budget, std::shared_ptr<UnderWay> under_way);

 private:
  class State;
};

}  // namespace adit::intake
