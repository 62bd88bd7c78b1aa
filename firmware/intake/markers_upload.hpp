#pragma once

#include <memory>

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/one_at_a_time.hpp"
#include "intake/worker_upload.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

/// Takes a markers update of at most kMost bytes, compressed or not.
///
/// Those of a few dozen markers are decoded on the loop as they arrive, and wait for nobody. Others are kept
/// as they come, and decoded on a worker once they are whole; one that turns out to be larger than
/// codec::Limits::text_bytes (a marker may have icd::kMostMarkerPoints), or to have more than kSmallValues,
/// when no other of those is: that takes much memory. No message is in memory as a tree: each marker is
/// parsed by itself, and each of its points.
///
/// Once whole and checked it is the desk's, even if the client has hung up by then. If the client hangs up
/// before, the update is dropped.
class MarkersUpload final : public WorkerUpload {
 public:
  /// Room for every marker there can be: one of 100,000 points and as many colors takes 7.9 MB of CBOR.
  static constexpr std::size_t kMost = 8u << 20;
  /// And for its values: 900,000, without their names.
  static constexpr std::size_t kMostValues = 1'000'000;

  MarkersUpload(Visit visit, codec::BodyKind kind, const icd::Rules& rules, loop::Workers& workers,
                std::shared_ptr<UploadBudget> budget, const std::shared_ptr<OneAtATime>& turns,
                std::shared_ptr<UnderWay> under_way);

 private:
  class State;
};

}  // namespace adit::intake
