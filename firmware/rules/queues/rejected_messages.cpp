#include "queues/rejected_messages.hpp"

#include <algorithm>
#include <utility>

namespace adit::queues {
namespace {

/// The bounds of a rejected grid and of all that it replaced; nothing for a cloud.
std::optional<icd::GridBounds> bounds_in(const icd::MapUpdate& map, const RejectedMessage& item) {
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&map.msg);
  if (grid == nullptr) return {};
  return item.bounds ? item.bounds : icd::GridBounds::from_grid(*grid);
}

bool contains_all(const icd::MapUpdate& newer, const icd::MapUpdate& older, const RejectedMessage& item) {
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&newer.msg);
  const auto bounds = bounds_in(older, item);
  return grid != nullptr && bounds && newer.name == older.name && icd::covers(*grid, *bounds);
}

bool contains_all(const icd::StateUpdate& newer, const icd::StateUpdate& older, const RejectedMessage&) {
  return std::ranges::all_of(older.poses, [&](const icd::NamedPose& pose) {
    return std::ranges::find(newer.poses, pose.name, &icd::NamedPose::name) != newer.poses.end();
  });
}

bool contains_all(const icd::MarkersUpdate& newer, const icd::MarkersUpdate& older, const RejectedMessage&) {
  return std::ranges::all_of(older.markers, [&](const icd::Marker& change) {
    return std::ranges::any_of(newer.markers, [&](const icd::Marker& later) {
      if (later.action == icd::MarkerAction::DeleteAll) return true;
      return change.action != icd::MarkerAction::DeleteAll && later.ns == change.ns && later.id == change.id;
    });
  });
}

/// A late DeleteAll would also delete newer markers.
bool deletes_newer(const Message& older, const Message& newer) {
  const auto* const markers = std::get_if<icd::MarkersUpdate>(&older);
  return markers != nullptr && std::holds_alternative<icd::MarkersUpdate>(newer) &&
         std::ranges::find(markers->markers, icd::MarkerAction::DeleteAll, &icd::Marker::action) !=
             markers->markers.end();
}

bool is_older_map(const Message& message, const Message& other) {
  const auto* const map = std::get_if<icd::MapUpdate>(&message);
  const auto* const other_map = std::get_if<icd::MapUpdate>(&other);
  return map != nullptr && other_map != nullptr && map->header().stamp < other_map->header().stamp;
}

bool contains_all_of(const Message& newer, const RejectedMessage& older) {
  return newer.index() == older.message.index() &&
         std::visit(
             [&]<class Kind>(const Kind& message) {
               return contains_all(message, std::get<Kind>(older.message), older);
             },
             newer);
}

/// `item` replaces `older`. Both are grids if one is.
void take_over(RejectedMessage& item, const RejectedMessage& older) {
  const auto* const map = std::get_if<icd::MapUpdate>(&item.message);
  if (map == nullptr) return;
  item.bounds =
      icd::joint_bounds(*bounds_in(*map, item), *bounds_in(std::get<icd::MapUpdate>(older.message), older));
}

}  // namespace

bool replaces(const Message& newer, const RejectedMessage& older) {
  return contains_all_of(newer, older) && !is_older_map(newer, older.message);
}

std::vector<std::uint64_t> RejectedMessages::add(RejectedMessage item) {
  std::vector<std::uint64_t> gone;
  const auto drop = [&](const RejectedMessage& each) {
    bytes_ -= each.bytes;
    gone.push_back(each.number);
  };
  std::erase_if(items_, [&](const RejectedMessage& older) {
    if (!replaces(item.message, older)) return false;
    take_over(item, older);
    drop(older);
    return true;
  });
  while (!items_.empty() && (items_.size() >= kMostItems || bytes_ + item.bytes > kMostBytes)) {
    drop(items_.front());
    items_.pop_front();
  }
  item.number = ++numbers_;
  bytes_ += item.bytes;
  items_.push_back(std::move(item));
  return gone;
}

void RejectedMessages::restore(RejectedMessage item) {
  numbers_ = std::max(numbers_, item.number);
  bytes_ += item.bytes;
  items_.push_back(std::move(item));
}

std::vector<std::uint64_t> RejectedMessages::replaced_by(const Message& newer) const {
  std::vector<std::uint64_t> replaced;
  for (const RejectedMessage& item : items_) {
    if (item.replaced) continue;
    if (!replaces(newer, item) && !deletes_newer(item.message, newer)) continue;
    replaced.push_back(item.number);
  }
  return replaced;
}

void RejectedMessages::mark_replaced(const std::vector<std::uint64_t>& numbers) {
  for (RejectedMessage& item : items_) {
    if (std::ranges::find(numbers, item.number) != numbers.end()) item.replaced = true;
  }
}

const RejectedMessage* RejectedMessages::find(std::uint64_t number) const {
  const auto found = std::ranges::find(items_, number, &RejectedMessage::number);
  return found == items_.end() ? nullptr : &*found;
}

std::optional<RejectedMessage> RejectedMessages::extract(std::uint64_t number) {
  const auto found = std::ranges::find(items_, number, &RejectedMessage::number);
  if (found == items_.end()) return std::nullopt;
  RejectedMessage item = std::move(*found);
  bytes_ -= item.bytes;
  items_.erase(found);
  return item;
}

}  // namespace adit::queues
