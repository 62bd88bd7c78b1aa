#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/state_update.hpp"

namespace adit::lanes {

using Message = std::variant<icd::MapUpdate, icd::StateUpdate, icd::MarkersUpdate>;

/// Whether `newer` says all that `older` said (promise 2): a grid of the same name that covers it, poses of
/// all its robots, changes of all its markers. Nothing covers a cloud; nor does an older map cover a newer
/// one: a message that is sent again by hand may be older than other rejected messages.
bool replaces(const Message& newer, const Message& older);

/// A message that the Command Post would not take, and why.
struct RejectedMessage {
  std::uint64_t number = 0;
  Message message;
  int status = 0;         // the Command Post's
  std::string why;        // its sentence
  double at = 0;          // seconds since 1970, on the gateway's clock
  std::size_t bytes = 0;  // as it is held
  bool replaced = false;  // something newer was taken that says all of it, or that it would delete
};

/// The messages that were rejected: kept to be seen, and to be sent again by hand. Holds at most kMostItems
/// and kMostBytes (but always one), the newest.
class RejectedMessages {
 public:
  static constexpr std::size_t kMostItems = 100, kMostBytes = std::size_t{64} << 20;

  /// Numbers it. Gives the numbers of those that went for it: what it says all of, and then the oldest.
  std::vector<std::uint64_t> add(RejectedMessage item);
  /// What was kept by an earlier life keeps its number.
  void restore(RejectedMessage item);

  /// The numbers of those that this replaces and nothing has before.
  std::vector<std::uint64_t> replaced_by(const Message& newer) const;
  /// The Command Post took what replaces these.
  void mark_replaced(const std::vector<std::uint64_t>& numbers);

  const RejectedMessage* find(std::uint64_t number) const;
  std::optional<RejectedMessage> take(std::uint64_t number);
  /// Oldest first.
  const std::deque<RejectedMessage>& items() const { return items_; }
  std::uint64_t last_number() const { return numbers_; }

 private:
  std::uint64_t numbers_ = 0;
  std::deque<RejectedMessage> items_;
  std::size_t bytes_ = 0;
};

}  // namespace adit::lanes
