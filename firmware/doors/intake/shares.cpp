#include "intake/shares.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <vector>

namespace adit::intake {
namespace {

/// Part of all connections. A browser that is not logged in opens six.
constexpr std::uint32_t kPartOfUnauthenticated = 4, kMostUnauthenticated = 32;

using Counts = std::map<std::string_view, std::size_t>;

Counts count_by_address(const std::vector<ConnectionInfo>& held) {
  Counts counts;
  for (const ConnectionInfo& each : held) ++counts[each.address];
  return counts;
}

std::optional<std::uint64_t> longest(const std::vector<ConnectionInfo>& held,
                                     ConnectionInfo::Activity doing) {
  const ConnectionInfo* found = nullptr;
  for (const ConnectionInfo& each : held) {
    if (each.doing == doing && (found == nullptr || each.since < found->since)) found = &each;
  }
  return found == nullptr ? std::nullopt : std::optional(found->number);
}

/// The connection that costs least to close.
std::optional<std::uint64_t> cheapest(const std::vector<ConnectionInfo>& held) {
  const auto idle = longest(held, ConnectionInfo::Activity::Idle);
  return idle ? idle : longest(held, ConnectionInfo::Activity::Left);
}

/// A connection of the address with most, if `address` would still have fewer with one more.
std::optional<std::uint64_t> find_greedy(std::string_view address, const std::vector<ConnectionInfo>& known) {
  Counts counts = count_by_address(known);
  const std::size_t own = counts[address] + 1;
  const ConnectionInfo* found = nullptr;
  for (const ConnectionInfo& each : known) {
    if (each.doing != ConnectionInfo::Activity::Sending || counts[each.address] < own + 1) continue;
    if (found == nullptr || counts[each.address] > counts[found->address] ||
        (counts[each.address] == counts[found->address] && each.number < found->number)) {
      found = &each;
    }
  }
  return found == nullptr ? std::nullopt : std::optional(found->number);
}

std::vector<ConnectionInfo> filter(std::span<const ConnectionInfo> held, const auto& which) {
  std::vector<ConnectionInfo> found;
  std::ranges::copy_if(held, std::back_inserter(found), which);
  return found;
}

}  // namespace

Shares Shares::split(std::uint32_t connections, std::uint32_t of_address) {
  const std::uint32_t unauthenticated =
      std::clamp(connections / kPartOfUnauthenticated, 1u, kMostUnauthenticated);
  const std::uint32_t known = std::max(connections, unauthenticated + 1) - unauthenticated;
  return {
      .unauthenticated = unauthenticated, .known = known, .known_of_address = std::min(of_address, known)};
}

std::optional<std::uint64_t> unauthenticated_to_close(std::span<const ConnectionInfo> held,
                                                      const Shares& shares) {
  const auto unauthenticated = filter(held, [](const ConnectionInfo& each) { return !each.known; });
  const auto seen = filter(unauthenticated, [](const ConnectionInfo& each) {
    return each.doing != ConnectionInfo::Activity::Fresh;
  });
  if (unauthenticated.size() <= shares.unauthenticated || seen.empty()) return std::nullopt;
  const Counts counts = count_by_address(unauthenticated);
  return std::ranges::min_element(seen, {},
                                  [&](const ConnectionInfo& each) {
                                    return std::tuple(-static_cast<std::int64_t>(counts.at(each.address)),
                                                      each.doing != ConnectionInfo::Activity::Idle,
                                                      each.number);
                                  })
      ->number;
}

Room room_for(std::string_view address, std::span<const ConnectionInfo> others, const Shares& shares) {
  const auto known = filter(others, &ConnectionInfo::known);
  const auto own =
      filter(others, [&](const ConnectionInfo& each) { return each.known && each.address == address; });
  std::optional<std::uint64_t> gives_way;
  if (own.size() >= shares.known_of_address) {
    gives_way = cheapest(own);
  } else if (known.size() >= shares.known) {
    gives_way = cheapest(known);
    if (!gives_way) gives_way = find_greedy(address, known);
  } else {
    return {};
  }
  return {.is_there = gives_way.has_value(), .gives_way = gives_way};
}

}  // namespace adit::intake
