#pragma once

#include <memory>

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/turn_queue.hpp"
#include "intake/worker_upload.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

/// Receives a markers update of at most kMost bytes, compressed or not.
///
/// The loop decodes an update of a few dozen markers as it arrives. Larger ones are kept as received, and a
/// worker decodes them when they are whole. An update that is larger than codec::Limits::text_bytes (a marker
/// may have icd::kMostMarkerPoints) or has more than kSmallValues takes much memory, so only one such update
/// is decoded at a time. No message is in memory as a tree: each marker and each of its points is parsed
/// separately.
///
/// A whole, checked update goes to the desk, even if the client has hung up by then. If the client hangs up
/// earlier, the update is dropped.
class MarkersUpload final : public WorkerUpload {
 public:
  /// Enough for each possible marker: one of 100,000 points and as many colors takes 7.9 MB of CBOR.
  static constexpr std::size_t kMost = 8u << 20;
  /// Such a marker has 900,000 values without their names.
  static constexpr std::size_t kMostValues = 1'000'000;

  MarkersUpload(const Visit& visit, codec::BodyKind kind, const icd::Rules& rules, loop::Workers& workers,
                std::shared_ptr<UploadBudget> budget, const std::shared_ptr<TurnQueue>& turns);

 private:
  class State;
};

}  // namespace adit::intake
