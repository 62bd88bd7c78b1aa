#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/upload.hpp"
#include "intake/visit.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

/// Receives a state or a report of at most a megabyte. The loop decodes it as it arrives.
class SmallUpload final : public Upload {
 public:
  SmallUpload(Visit visit, codec::BodyKind kind, const icd::Rules& rules,
              std::shared_ptr<UploadBudget> budget)
      : Upload(visit),
        visit_(std::move(visit)),
        share_(std::move(budget), visit_.sender.address),
        rules_(rules),
        decoder_(kind, codec::Split::Nothing, {.values = kSmallValues}) {
    visit_.sender.bytes = 0;
  }

  bool on_body(std::span<const std::uint8_t> piece) override;
  void on_end() override;
  void turn_away(const icd::Refusal& refusal) override {
    if (!whole_) visit_.refuse(refusal);
  }

 private:
  void give_to_desk(const codec::Document& document);
  /// Gives the accepted parts to the desk. If the desk accepts them, the answer is about the rejected parts.
  void take_state(const codec::Document& document);
  void take_report(const codec::Document& document);

  Visit visit_;
  UploadShare share_;
  icd::Rules rules_;
  codec::BodyDecoder decoder_;
  bool whole_ = false;
};

struct MapUploadOptions {
  codec::BodyKind kind;
  icd::Rules rules;
  std::size_t most_bytes = 0;                  // the most of the body
  std::shared_ptr<UploadBudget> without_room;  // for maps that are held because they cannot be stored
};

/// Receives a map. A worker decodes the body as it arrives, one job at a time. The client must wait while
/// more than kPending bytes wait for the worker. Decoded data is stored kStored bytes or more at a time. If
/// as much again is decoded before that is stored, the worker pauses. So a large map is never in memory as a
/// whole. If a grid says before its data that it is a grid, as most do, its cells are gzipped as they are
/// decoded (codec::PressedCells), and the map is nearly packed when its last byte arrives.
///
/// A compressed body may grow a thousandfold. It is decoded in steps of little more than kStored, and its
/// decoded size counts in the budget. If it cannot be stored, it stays in memory until it is checked. All
/// such maps together have kWithoutRoom; a map that needs more is rejected.
///
/// A whole, checked map goes to the desk, which answers when the map is stored, even if the client has hung
/// up by then. If the client hangs up earlier, the map is dropped.
class MapUpload final : public WorkerUpload {
 public:
  static constexpr std::size_t kPending = 256 * 1024, kStored = 256 * 1024;
  static constexpr std::size_t kTogether =
      64 * 1024;  // the least bytes of a job, except at the beginning and the end
  static constexpr std::size_t kWithoutRoom = 24u << 20;

  MapUpload(const Visit& visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
            std::shared_ptr<UploadBudget> budget);

 private:
  class State;
};

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
