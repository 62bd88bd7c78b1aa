// GridArrived replays the cells of all grids that the Command Post accepted. Replaced judges each sent grid.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <deque>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/asked.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/map_messages.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"

namespace adit::simulation {
namespace {

/// A grid that failed this often at the Command Post lets newer grids pass (queues/map_queue.hpp).
constexpr int kInPlace = 3;
constexpr int kNoValue = 255;

struct PostedGrid {
  const Asked* asked;
  std::int64_t serial;
  Extent extent;
  std::size_t taken = 0;    // the last event that delivered it; 0: none
  int failures = 0;         // answers of 5xx or 413 to it
  bool has_left = false;    // it was sent, alone or in a message with others
  bool is_taken = false;    // an answer confirmed the delivery
  double confirmed = 1e9;   // when
  bool is_refused = false;  // rejected; the operator sends it again later
  std::set<int> rows = {};  // delivered, if it was sent in pieces

  bool has_all_rows() const { return std::cmp_equal(rows.size(), extent.height); }

  void answered(const Event& reply) {
    if (reply.status >= 500 || reply.status == 413) ++failures;
    if (reply.status == 200 && reply.who.empty() && (rows.empty() || has_all_rows()))
      is_taken = true, confirmed = std::min(confirmed, reply.at);
    is_refused = is_refused || reply.status == 422 || reply.status == 413;
  }
  bool is_overtaken_by(const PostedGrid& other) const {
    return extent.cell == other.extent.cell && 2 * std::abs(extent.z - other.extent.z) < extent.cell &&
           is_overtaken(*asked, asked->items.front(), *other.asked, other.asked->items.front());
  }
  bool is_before(const PostedGrid& other) const {
    return asked->ended < other.asked->began || is_overtaken_by(other);
  }
};

/// Whether the cells of `inner` are cells of `outer`.
bool holds(const Extent& outer, const Extent& inner) {
  const auto is_between = [cell = outer.cell](int begin, int size, int outer_begin, int outer_size) {
    const int from = begin - outer_begin;
    return from >= 0 && from % cell == 0 && from / cell + size <= outer_size;
  };
  return outer.cell == inner.cell && outer.z == inner.z &&
         is_between(inner.x, inner.width, outer.x, outer.width) &&
         is_between(inner.y, inner.height, outer.y, outer.height);
}

/// ICD 6.3.1: whether a newer `outer` replaces everything in `inner`, on one lattice or on two: no part of
/// `inner` is outside by more than half a cell.
bool covers(const Extent& outer, const Extent& inner) {
  const int half = outer.cell / 2;
  const auto is_between = [&](int begin, int size, int outer_begin, int outer_size) {
    return begin >= outer_begin - half &&
           begin + size * inner.cell <= outer_begin + outer_size * outer.cell + half;
  };
  return outer.cell == inner.cell && std::abs(outer.z - inner.z) <= half &&
         is_between(inner.x, inner.width, outer.x, outer.width) &&
         is_between(inner.y, inner.height, outer.y, outer.height);
}

/// With half a cell more on each side.
Extent widened(const Extent& extent) {
  const int half = extent.cell / 2;
  return {extent.cell, extent.x - half, extent.y - half, extent.width + 1, extent.height + 1, extent.z};
}

bool overlap(const Extent& a, const Extent& b) {
  const auto one = [&](int a_begin, int a_size, int b_begin, int b_size) {
    return a_begin < b_begin + b_size * b.cell && b_begin < a_begin + a_size * a.cell;
  };
  return one(a.x, a.width, b.x, b.width) && one(a.y, a.height, b.y, b.height);
}

/// Whether `rows` are some of the rows of `all`.
bool are_rows_of(const Extent& all, const Extent& rows) {
  return holds(all, rows) && rows.width == all.width && rows.height < all.height;
}

bool is_one_place(const Extent& a, const Extent& b) {
  return a.says() == b.says();
}

/// Visits each cell of an extent, row by row, as an extent of its own.
template <class Visit>
void for_each_cell(const Extent& extent, Visit visit) {
  for (int row = 0; row < extent.height; ++row) {
    for (int column = 0; column < extent.width; ++column)
      visit(
          Extent{extent.cell, extent.x + extent.cell * column, extent.y + extent.cell * row, 1, 1, extent.z});
  }
}

/// The grids of one name, and the cells that the Command Post has of them. If an operator `switches`
/// between two Command Posts, the cells of both count together, and a cell that is missing at one is no
/// violation. Neither is a cell that was sent by a process of which the box has no record. A cell that was
/// sent in an earlier run may be missing, because a run begins with an empty map.
class GridsOfOneName {
 public:
  explicit GridsOfOneName(bool has_more_maps) : has_more_maps_(has_more_maps) {}
  void begin_run(std::size_t place) { run_began_ = place; }
  void post(const Asked& asked, const Item& item) {
    posted_.push_back({&asked, item.serial, Extent::from(item.says)});
  }

  /// A grid left, or was accepted. Returns the posted grids that the message contains, or is a part of.
  std::vector<PostedGrid*> sent(const Event& event) {
    std::vector<PostedGrid*> in_it;
    const Message message = read(event);
    for (PostedGrid* each : message.within) {
      const auto is_its = [&](const Owners& owners) { return owners.size() == 1 && owners.front() == each; };
      if (!each->is_taken || std::ranges::any_of(message.cells, is_its)) in_it.push_back(each);
    }
    const Owners wholes = wholes_of(event);
    in_it.insert(in_it.end(), wholes.begin(), wholes.end());
    return in_it;
  }

  /// A grid left for the first time. `since`: the queue had no newer grid then that contains it and all that
  /// it may have replaced, from a client that heard 200. `began`: when the process began, because none of the
  /// grids that a process finds replaces another.
  void left(const Event& event, double since, double began, Broken& broken) {
    const Message message = read(event);
    Owners its;
    for (PostedGrid* each : message.within) {
      const bool is_it = is_one_place(each->extent, message.extent) && !each->has_left &&
                         std::ranges::all_of(message.cells, [&](const Owners& owners) {
                           return std::ranges::find(owners, each) != owners.end();
                         });
      if (is_it) its.push_back(each);
    }
    for (PostedGrid* each : message.within) each->has_left = true;
    if (its.size() != 1) return;
    const PostedGrid& grid = *its.front();
    const auto contains_all = [&](const PostedGrid& newer) {
      return std::ranges::all_of(posted_, [&](const PostedGrid& older) {
        const bool may_be_in_it = older.confirmed > grid.asked->began && !grid.is_before(older) &&
                                  overlap(older.extent, grid.extent);
        return !may_be_in_it || covers(newer.extent, older.extent);
      });
    };
    const auto was_queued = [&](const PostedGrid& newer) {
      return !may_be_overtaken(newer) && newer.asked->accepted() && newer.asked->began > began &&
             newer.asked->ended < since && grid.is_before(newer);
    };
    // While a grid waits for a connection it stays, and meanwhile another one may replace the newer one.
    const auto may_have_gone = [&](const PostedGrid& newer) {
      return std::ranges::any_of(posted_, [&](const PostedGrid& later) {
        return newer.is_before(later) && covers(later.extent, newer.extent) && !contains_all(later);
      });
    };
    for (const PostedGrid& newer : posted_) {
      if (!was_queued(newer) || !contains_all(newer) || may_have_gone(newer)) continue;
      broken.push_back(icd::sentence("Replaced: ", event.who, "'s ", grid.serial, " was sent at ", event.at,
                                     ", although the newer ", newer.serial, " contains it"));
      return;
    }
  }

  void taken(const Event& event, std::size_t place, Broken& broken) {
    const Message message = read(event);
    for (PostedGrid* each : wholes_of(event)) {
      const int first = (message.extent.y - each->extent.y) / message.extent.cell;
      for (int row = 0; row < message.extent.height; ++row) each->rows.insert(first + row);
      if (each->has_all_rows()) each->taken = place;
    }
    std::size_t i = 0;
    bool is_strange = false;
    for_each_cell(message.extent, [&](const Extent& cell) {
      const int value = event.says.at(kExtentNumbers + i);
      const Owners& within = message.cells[i++];
      if (within.size() == 1 && !within.front()->is_taken) within.front()->taken = place;
      Owners owners = owners_of(cell, value, event.at);
      const auto had = has_.find(key_of(cell));
      const bool was_sent = had != has_.end();
      const bool is_earlier = was_sent && had->second.place < run_began_;
      // A grid of an earlier run may have the value of a gap by chance.
      const bool is_blank =
          value == kNoValue && is_earlier &&
          std::ranges::none_of(owners, [&](const PostedGrid* owner) { return may_come(*owner); });
      const std::size_t since = is_blank ? had->second.place : place;
      if (value == kNoValue && was_sent && (has_more_maps_ || is_earlier))
        owners.insert(owners.end(), had->second.owners.begin(), had->second.owners.end());
      is_strange = is_strange || (owners.empty() && (value != kNoValue || was_sent));
      if (!owners.empty()) has_[key_of(cell)] = {since, owners};
    });
    if (is_strange)
      broken.push_back(
          icd::sentence("GridArrived: the Command Post accepted cells that no client posted, of '", event.who,
                        "' at ", event.at));
  }

  void check(const std::string& name, Broken& broken) const {
    for (const PostedGrid& grid : posted_) {
      if (!grid.asked->accepted()) continue;
      if (!is_there(grid)) {
        broken.push_back(
            icd::sentence("GridArrived: ", name, "'s ", grid.serial,
                          " was answered 200, but the Command Post has older cells there, or none"));
      }
      for (const PostedGrid& older : posted_) {
        const bool may_be_over = older.taken > 0 && older.is_before(grid) &&
                                 overlap(older.extent, grid.extent) && !lets_newer_pass(older);
        if (!may_be_over || !is_under(grid, older)) continue;
        broken.push_back(icd::sentence("GridArrived: ", name, "'s ", older.serial,
                                       " was delivered after the newer ", grid.serial,
                                       ", for it was taken last"));
      }
    }
  }

 private:
  /// The posted grids that have the cell's value at its place. One of them is the cell's owner.
  using Owners = std::vector<PostedGrid*>;
  struct Message {
    Extent extent;
    std::vector<PostedGrid*> within;  // the posted grids that lie within the message
    std::vector<Owners> cells;
  };
  struct Has {
    std::size_t place = 0;  // the event that delivered it
    Owners owners;
  };
  using Key = std::tuple<int, int, int, int>;
  static Key key_of(const Extent& cell) { return {cell.cell, cell.x, cell.y, cell.z}; }

  Message read(const Event& event) {
    Message message{Extent::from(event.says), {}, {}};
    for (PostedGrid& each : posted_) {
      if (each.asked->began <= event.at && each.asked->may_count() && holds(message.extent, each.extent))
        message.within.push_back(&each);
    }
    std::size_t i = kExtentNumbers;
    for_each_cell(message.extent, [&](const Extent& cell) {
      const int value = event.says.at(i++);
      Owners owners;
      for (PostedGrid* each : message.within) {
        if (holds(each->extent, cell) && value_of(each->serial, cell) == value) owners.push_back(each);
      }
      message.cells.push_back(std::move(owners));
    });
    if (event.kind == Kind::Taken) leave_out_what_is_not_in(message);
    return message;
  }

  /// The posted grids of which the message has some rows.
  Owners wholes_of(const Event& event) {
    Owners wholes;
    const Extent extent = Extent::from(event.says);
    for (PostedGrid& each : posted_) {
      const bool may_be = each.asked->began <= event.at && each.asked->may_count();
      if (!may_be || !are_rows_of(each.extent, extent)) continue;
      std::size_t i = kExtentNumbers;
      bool is_it = true;
      for_each_cell(extent, [&](const Extent& cell) {
        is_it = is_it && value_of(each.serial, cell) == event.says.at(i++);
      });
      if (is_it) wholes.push_back(&each);
    }
    return wholes;
  }

  /// A message with gaps does not contain every grid that lies within it, and a gap may have a grid's value
  /// by chance. A contained grid has at each cell its own value or the value of a grid that is not older,
  /// even if that grid has replaced it.
  static void leave_out_what_is_not_in(Message& message) {
    Owners not_in;
    for (PostedGrid* grid : message.within) {
      std::size_t i = 0;
      bool is_in = true;
      for_each_cell(message.extent, [&](const Extent& cell) {
        const Owners& owners = message.cells[i++];
        is_in =
            is_in && (!holds(grid->extent, cell) || std::ranges::any_of(owners, [&](const PostedGrid* owner) {
              return !owner->is_before(*grid);
            }));
      });
      if (!is_in) not_in.push_back(grid);
    }
    const auto leave_out = [&](Owners& of) {
      std::erase_if(of, [&](PostedGrid* each) { return std::ranges::find(not_in, each) != not_in.end(); });
    };
    leave_out(message.within);
    std::ranges::for_each(message.cells, leave_out);
  }

  /// Whether the grid was delivered in this run, or may still be.
  bool may_come(const PostedGrid& grid) const {
    if (grid.taken > 0) return grid.taken >= run_began_;
    return std::ranges::none_of(posted_, [&](const PostedGrid& newer) {
      return newer.taken > 0 && newer.taken < run_began_ && grid.is_before(newer) &&
             covers(newer.extent, grid.extent);
    });
  }

  /// The posted grids that have that value there, even if they are larger than the message: a grid that was
  /// sent before may be sent as a part.
  Owners owners_of(const Extent& cell, int value, double at) {
    Owners owners;
    for (PostedGrid& each : posted_) {
      if (each.asked->began <= at && each.asked->may_count() && holds(each.extent, cell) &&
          value_of(each.serial, cell) == value)
        owners.push_back(&each);
    }
    return owners;
  }

  /// Whether a newer one may have been accepted after its upload had begun, so that only its other cells were
  /// queued.
  bool may_be_overtaken(const PostedGrid& grid) const {
    return std::ranges::any_of(posted_, [&](const PostedGrid& newer) {
      return newer.asked->may_count() && newer.asked->began > grid.asked->began &&
             newer.asked->whole_at < grid.asked->ended;
    });
  }

  /// Each of its cells has the grid's value, or the value of a grid that is not older or that this grid let
  /// pass, or was covered later by a grid on another lattice that is not older. Or an accepted grid that
  /// overtook this one covers it, whose own cells count then. If this grid was overtaken, another one may
  /// have replaced the one that overtook it, so both cover to a whole cell.
  bool is_there(const PostedGrid& grid) const {
    const bool is_widened = may_be_overtaken(grid);
    bool all = true;
    for_each_cell(grid.extent, [&](const Extent& cell) {
      const auto found = has_.find(key_of(cell));
      const Has has = found == has_.end() ? Has{} : found->second;
      const bool has_it = std::ranges::any_of(has.owners, [&](const PostedGrid* owner) {
        return !owner->is_before(grid) || lets_newer_pass(*owner);
      });
      all = all && (has_it || std::ranges::any_of(posted_, [&](const PostedGrid& newer) {
                      const bool came_later = newer.taken > has.place && !newer.is_before(grid);
                      const bool overtook = newer.asked->accepted() && grid.is_overtaken_by(newer);
                      return (came_later || overtook) &&
                             covers(is_widened ? widened(newer.extent) : newer.extent, cell);
                    }));
    });
    return all;
  }

  /// Whether `older`, perhaps on another lattice, was accepted after a part of a grid that covers it. A cell
  /// that may have the value of another grid is no part of it, unless that grid is newer. A grid that was
  /// overtaken may reach half a cell into the newer one.
  bool is_under(const PostedGrid& grid, const PostedGrid& older) const {
    bool any = false;
    Extent reach = older.extent;
    if (older.is_overtaken_by(grid))
      reach = {reach.cell,      reach.x + reach.cell / 2, reach.y + reach.cell / 2,
               reach.width - 1, reach.height - 1,         reach.z};
    for_each_cell(grid.extent, [&](const Extent& cell) {
      const auto found = has_.find(key_of(cell));
      any = any || (overlap(cell, reach) && found != has_.end() && found->second.place < older.taken &&
                    std::ranges::all_of(
                        found->second.owners,
                        [&](const PostedGrid* owner) { return owner == &grid || grid.is_before(*owner); }));
    });
    return any;
  }

  /// Counts the failures of the grid and of the grids that it may have replaced.
  bool lets_newer_pass(const PostedGrid& grid) const {
    int failures = grid.failures;
    for (const PostedGrid& older : posted_) {
      const bool may_be_replaced = &older != &grid && !grid.is_before(older) && !older.is_taken &&
                                   !older.is_refused && covers(grid.extent, older.extent);
      if (may_be_replaced) failures += older.failures;
    }
    return grid.is_refused || failures >= kInPlace;
  }

  bool has_more_maps_;
  std::size_t run_began_ = 0;  // the event with which the run began
  std::deque<PostedGrid> posted_;
  std::map<Key, Has> has_;
};

/// Whether a power cut followed a process that could write nothing to disk. If the cut ended that process,
/// the next process takes itself for the first. If the cut came earlier, this process knows nothing of
/// earlier messages. A process in between that ended at its start has written nothing either.
bool knows_nothing(const Evidence& evidence) {
  constexpr double kTooShort = 1;         // seconds
  std::set<std::int64_t> unwritten, cut;  // lives
  std::map<std::int64_t, double> length;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Said && event.text.contains("stamps may run backward"))
      unwritten.insert(event.process);
    if (event.kind == Kind::PowerCut) cut.insert(event.serial);
    if (event.kind == Kind::Begins) length[event.process] = -event.at;
    if (event.kind == Kind::Ended) length[event.process] += event.at;
  }
  return std::ranges::any_of(unwritten, [&](std::int64_t process) {
    if (cut.contains(process - 1)) return true;
    std::int64_t last = process;
    while (!cut.contains(last) && length.contains(last + 1) && length[last + 1] < kTooShort) ++last;
    return cut.contains(last);
  });
}

}  // namespace

void grid_arrived(const Evidence& evidence, Broken& broken) {
  const auto all = asked_in(evidence.events, kMap);
  const bool has_more_maps =
      knows_nothing(evidence) ||
      std::ranges::any_of(evidence.events, [](const Event& event) { return event.what == kCourse; });
  std::map<std::string, GridsOfOneName> names;
  const auto of = [&](const std::string& name) -> GridsOfOneName& {
    return names.try_emplace(name, has_more_maps).first->second;
  };
  for (const Asked& asked : all) {
    const Item& item = asked.items.front();
    if (is_grid(item.says)) of(item.who).post(asked, item);
  }
  std::map<std::uint64_t, std::vector<PostedGrid*>> last_sent;  // by connection
  double began = 0, switched = 0;                               // the process, the course
  std::map<std::uint64_t, double> left;                         // when the last map of each connection left
  // When the last two delivered maps left, the latest first. One more map may be prepared before they arrive.
  std::array<double, 2> delivered{-1, -1};
  for (std::size_t i = 0; i < evidence.events.size(); ++i) {
    const Event& event = evidence.events[i];
    if (event.kind == Kind::NewRun && event.what != kSameMap) {
      for (auto& [name, grids] : names) grids.begin_run(i);
    }
    if (event.kind == Kind::Begins) began = event.at;
    if (event.kind == Kind::Saved && event.what == kCourse) switched = event.at;
    if (event.what != kMap) continue;
    if (event.kind == Kind::Leaves) left[event.request] = event.at;
    if (event.kind == Kind::Replied && event.status == 200) delivered = {left[event.request], delivered[0]};
    // A serial server reads requests of a process that has ended long after the next one has begun, and a
    // Command Post that stood still those from before a switch.
    constexpr double kReadLate = 5;
    const double since = left[event.request];
    if (event.kind == Kind::Taken && since < std::max(began, switched) && event.at - since > kReadLate)
      continue;
    std::vector<PostedGrid*>& sent = last_sent[event.request];
    if (event.kind == Kind::Replied) {
      for (PostedGrid* each : sent) each->answered(event);
    }
    if (event.kind != Kind::Taken && event.kind != Kind::Left) continue;
    sent.clear();
    if (!is_grid(event.says)) continue;
    if (event.kind == Kind::Left) of(event.who).left(event, delivered[1], began, broken);
    sent = of(event.who).sent(event);
    if (event.kind == Kind::Taken) of(event.who).taken(event, i, broken);
  }
  for (const auto& [name, grids] : names) grids.check(name, broken);
}

}  // namespace adit::simulation
