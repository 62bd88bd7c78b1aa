#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "icd/grid_bounds.hpp"
#include "icd/mapping.hpp"

namespace adit::queues {

using Message = std::variant<icd::MapUpdate, icd::StateUpdate, icd::MarkersUpdate>;

/// A message that the Command Post rejected, or a map that aditd put aside, and why.
struct RejectedMessage {
  std::uint64_t number = 0;
  Message message;
  int status = 0;         // the Command Post's; 0: put aside
  std::string why;        // its sentence
  double at = 0;          // seconds since 1970, on the gateway's clock
  std::size_t bytes = 0;  // as it is held
  bool replaced = false;  // a newer accepted message contains it, or is one that it would delete
  /// QueuedMap::bounds: a grid stands for those that it replaced while it was queued, or here.
  std::optional<icd::GridBounds> bounds{};
  /// Of a map that was put aside: the faults that ended aditd while it packed the map.
  int faults = 0;
};

/// Whether `newer` contains all of `older` (promise 2): it is a grid of the same name that covers `older`, or
/// has poses of all its robots, or changes of all its markers. False for clouds, and if `newer` has the older
/// stamp: a message that the operator sends again may be older than other rejected messages.
bool replaces(const Message& newer, const RejectedMessage& older);

/// Rejected messages, kept for the operator. The newest: at most kMostItems and kMostBytes, but always one.
class RejectedMessages {
 public:
  static constexpr std::size_t kMostItems = 100, kMostBytes = std::size_t{64} << 20;

  /// Adds `item` under the next number. Returns the numbers dropped for it: those in it, then the oldest.
  std::vector<std::uint64_t> add(RejectedMessage item);
  /// Adds a message of an earlier process under its own number.
  void restore(RejectedMessage item);

  /// The numbers of the messages that `newer` replaces and that are not replaced yet.
  std::vector<std::uint64_t> replaced_by(const Message& newer) const;
  /// The Command Post accepted a message that replaces these.
  void mark_replaced(const std::vector<std::uint64_t>& numbers);

  const RejectedMessage* find(std::uint64_t number) const;
  std::optional<RejectedMessage> extract(std::uint64_t number);
  /// Oldest first.
  const std::deque<RejectedMessage>& items() const { return items_; }

 private:
  std::uint64_t numbers_ = 0;
  std::deque<RejectedMessage> items_;
  std::size_t bytes_ = 0;
};

}  // namespace adit::queues
