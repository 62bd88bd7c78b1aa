// GridArrived and CloudArrived.
#include <algorithm>
#include <map>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/asked.hpp"
#include "simulation/checks.hpp"
#include "simulation/judge.hpp"
#include "simulation/messages.hpp"
#include "simulation/upstream_view.hpp"

namespace adit::simulation {
namespace {

/// A grid that failed so often at the Command Post lets newer ones pass, to see whether they can.
constexpr int kInPlace = 3;

/// A grid or cloud that was posted, and the events by which it was taken.
struct Posted {
  const Asked* asked;
  const Item* item;
  std::vector<std::size_t> taken = {};
  int failures = 0;         // answers of 5xx to it
  bool is_taken = false;    // as an answer said
  bool is_refused = false;  // it is set aside, and follows later at the operator's word

  void answered(const Event& reply) {
    if (reply.status >= 500) ++failures;
    is_taken = is_taken || (reply.status == 200 && reply.who.empty());
    is_refused = is_refused || reply.status == 422;
  }
  bool is_before(const Posted& other) const { return asked->ended < other.asked->began; }
};
using Name = std::string;

/// Whether `size` cells from `begin`, in half cells, lie within those.
bool within(int begin, int size, int outer_begin, int outer_size) {
  const int halves = begin - outer_begin;
  return halves >= 0 && halves % 2 == 0 && halves / 2 + size <= outer_size;
}

/// ICD 6.3.1: whether `newer` says all that `older` said.
bool covers(const Extent& newer, const Extent& older) {
  return newer.centimetres == older.centimetres && within(older.x, older.width, newer.x, newer.width) &&
         within(older.y, older.height, newer.y, newer.height);
}

/// Whether they have any place in common.
bool overlap(const Extent& a, const Extent& b) {
  const auto one = [&](int a_begin, int a_size, int b_begin, int b_size) {
    return a_begin * a.centimetres < (b_begin + 2 * b_size) * b.centimetres &&
           b_begin * b.centimetres < (a_begin + 2 * a_size) * a.centimetres;
  };
  return one(a.x, a.width, b.x, b.width) && one(a.y, a.height, b.y, b.height);
}

/// Of each name, those grids or clouds that may have counted.
std::map<Name, std::vector<Posted>> posted_in(const Evidence& evidence, const std::vector<Asked>& all,
                                              bool grids) {
  std::map<Name, std::vector<Posted>> posted;
  std::map<std::int64_t, std::pair<Name, std::size_t>> by_serial;
  for (const Asked& asked : all) {
    const Item& item = asked.items.front();
    if (is_grid(item.says) != grids || !asked.may_count()) continue;
    auto& of_it = posted[item.who];
    by_serial[item.serial] = {item.who, of_it.size()};
    of_it.push_back({&asked, &item});
  }
  Posted* sent = nullptr;  // last
  for (std::size_t i = 0; i < evidence.events.size(); ++i) {
    const Event& event = evidence.events[i];
    if (event.what != kMap) continue;
    if (event.kind == Kind::Replied && sent != nullptr) sent->answered(event);
    if (event.kind != Kind::Taken && event.kind != Kind::Left) continue;
    sent = nullptr;
    const auto found = by_serial.find(event.serial);
    if (is_grid(event.says) != grids || found == by_serial.end() || found->second.first != event.who)
      continue;
    Posted& each = posted[event.who][found->second.second];
    sent = &each;
    if (event.kind == Kind::Taken && each.item->says == event.says) each.taken.push_back(i);
  }
  return posted;
}

/// It, or one that is no older and covers it, was taken after that event.
bool is_covered(const Posted& grid, const std::vector<Posted>& all, std::size_t event) {
  return std::ranges::any_of(all, [&](const Posted& other) {
    return !other.taken.empty() && other.taken.back() > event && !other.is_before(grid) &&
           covers(Extent::from(other.item->says), Extent::from(grid.item->says));
  });
}

/// Its failures count with those of what it may have replaced.
bool lets_newer_pass(const Posted& grid, const std::vector<Posted>& all) {
  int failures = grid.failures;
  for (const Posted& older : all) {
    const bool may_be_replaced = &older != &grid && !grid.is_before(older) && !older.is_taken &&
                                 !older.is_refused &&
                                 covers(Extent::from(grid.item->says), Extent::from(older.item->says));
    if (may_be_replaced) failures += older.failures;
  }
  return grid.is_refused || failures >= kInPlace;
}

/// Those of one name.
void check_grids(const Name& name, const std::vector<Posted>& all, Broken& broken) {
  for (const Posted& grid : all) {
    if (!grid.asked->accepted()) continue;
    if (!is_covered(grid, all, 0)) {
      broken.push_back(icd::sentence("GridArrived: ", name, "'s ", grid.item->serial,
                                     " was answered 200, and none that covers it was taken"));
    }
    for (const Posted& older : all) {
      const bool is_under = older.is_before(grid) && !older.taken.empty() && !lets_newer_pass(older, all) &&
                            overlap(Extent::from(older.item->says), Extent::from(grid.item->says));
      if (!is_under || is_covered(grid, all, older.taken.back())) continue;
      broken.push_back(icd::sentence("GridArrived: ", name, "'s ", older.item->serial,
                                     " lies over its newer ", grid.item->serial, ", for it was taken last"));
    }
  }
}

/// Between one taking and the next the process was killed, or the first one's answer was lost or no 200; or
/// the operator sent again what was still set aside after a kill, though it waited by then, or was set aside
/// twice.
bool may_be_double(const std::vector<Event>& events, std::size_t first, std::size_t second) {
  const auto is_kill = [](const Event& event) { return event.kind == Kind::Dies; };
  const auto is_word = [](const Event& event) {
    return event.kind == Kind::Invoke && event.what == kSendAside;
  };
  const auto at = [&](std::size_t place) { return events.begin() + static_cast<std::ptrdiff_t>(place); };
  const auto kill = std::find_if(at(0), at(second), is_kill);
  if (std::any_of(kill, at(second), is_word)) return true;
  int status = -1;
  for (std::size_t i = first; i < second; ++i) {
    const Event& event = events[i];
    if (event.kind == Kind::Dies) return true;
    if (event.what != kMap || status >= 0) continue;
    if (event.kind == Kind::Leaves) status = 0;
    if (event.kind == Kind::Replied && event.who.empty()) status = event.status;
  }
  return status != 200;
}

void check_clouds(const Evidence& evidence, const Name& name, const std::vector<Posted>& all,
                  Broken& broken) {
  for (const Posted& cloud : all) {
    if (cloud.asked->accepted() && cloud.taken.empty()) {
      broken.push_back(icd::sentence("CloudArrived: ", cloud.item->serial, " of '", name,
                                     "' was answered 200, and no cloud with all its points was taken"));
    }
    for (std::size_t i = 1; i < cloud.taken.size(); ++i) {
      if (may_be_double(evidence.events, cloud.taken[i - 1], cloud.taken[i])) continue;
      broken.push_back(icd::sentence("CloudArrived: ", cloud.item->serial, " of '", name,
                                     "' was taken again at ", evidence.events[cloud.taken[i]].at));
    }
  }
}

}  // namespace

void grid_arrived(const Evidence& evidence, Broken& broken) {
  const auto all = asked_in(evidence.events, kMap);
  for (const auto& [name, grids] : posted_in(evidence, all, true)) check_grids(name, grids, broken);
}

void cloud_arrived(const Evidence& evidence, Broken& broken) {
  for (const Event& event : evidence.events) {
    const bool taken = event.kind == Kind::Taken && event.what == kMap && is_cloud(event.says);
    if (taken && event.says.front() == kStrange)
      broken.push_back(
          icd::sentence("CloudArrived: points that nobody posted were taken from '", event.who, "'"));
  }
  const auto all = asked_in(evidence.events, kMap);
  for (const auto& [name, clouds] : posted_in(evidence, all, false))
    check_clouds(evidence, name, clouds, broken);
}

}  // namespace adit::simulation
