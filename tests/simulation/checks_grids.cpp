// GridArrived: replays the cells of all grids that the Command Post accepted.
#include <algorithm>
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
  int failures = 0;         // answers of 5xx to it
  bool is_taken = false;    // an answer confirmed the delivery
  bool is_refused = false;  // rejected; the operator sends it again later

  void answered(const Event& reply) {
    if (reply.status >= 500) ++failures;
    is_taken = is_taken || (reply.status == 200 && reply.who.empty());
    is_refused = is_refused || reply.status == 422;
  }
  bool is_before(const PostedGrid& other) const { return asked->ended < other.asked->began; }
};

/// Whether `size` cells from `begin` lie within `outer_size` cells from `outer_begin`. Origins are in half
/// cells.
bool lies_within(int begin, int size, int outer_begin, int outer_size) {
  const int halves = begin - outer_begin;
  return halves >= 0 && halves % 2 == 0 && halves / 2 + size <= outer_size;
}

/// ICD 6.3.1: whether a newer `outer` replaces everything in `inner`.
bool holds(const Extent& outer, const Extent& inner) {
  return outer.centimetres == inner.centimetres && lies_within(inner.x, inner.width, outer.x, outer.width) &&
         lies_within(inner.y, inner.height, outer.y, outer.height);
}

bool overlap(const Extent& a, const Extent& b) {
  const auto one = [&](int a_begin, int a_size, int b_begin, int b_size) {
    return a_begin * a.centimetres < (b_begin + 2 * b_size) * b.centimetres &&
           b_begin * b.centimetres < (a_begin + 2 * a_size) * a.centimetres;
  };
  return one(a.x, a.width, b.x, b.width) && one(a.y, a.height, b.y, b.height);
}

/// Visits each cell of an extent, row by row, as an extent of its own.
template <class Visit>
void for_each_cell(const Extent& extent, Visit visit) {
  for (int row = 0; row < extent.height; ++row) {
    for (int column = 0; column < extent.width; ++column)
      visit(Extent{extent.centimetres, extent.x + 2 * column, extent.y + 2 * row, 1, 1});
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

  /// A grid left, or was accepted. Returns the posted grids that the message contains.
  std::vector<PostedGrid*> sent(const Event& event) {
    std::vector<PostedGrid*> in_it;
    const Message message = read(event);
    for (PostedGrid* each : message.within) {
      const auto is_its = [&](const Owners& owners) { return owners.size() == 1 && owners.front() == each; };
      if (!each->is_taken || std::ranges::any_of(message.cells, is_its)) in_it.push_back(each);
    }
    return in_it;
  }

  void taken(const Event& event, std::size_t place, Broken& broken) {
    const Message message = read(event);
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
      const bool is_of_run = std::ranges::any_of(
          owners, [&](const PostedGrid* owner) { return owner->taken == 0 || owner->taken >= run_began_; });
      const bool is_blank = value == kNoValue && is_earlier && !is_of_run;
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
  using Key = std::tuple<int, int, int>;
  static Key key_of(const Extent& cell) { return {cell.centimetres, cell.x, cell.y}; }

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
        if (holds(each->extent, cell) && value_of(each->serial, cell.x, cell.y) == value)
          owners.push_back(each);
      }
      message.cells.push_back(std::move(owners));
    });
    if (event.kind == Kind::Taken) leave_out_what_is_not_in(message);
    return message;
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

  /// The posted grids that have that value there, even if they are larger than the message: a grid that was
  /// sent before may be sent as a part.
  Owners owners_of(const Extent& cell, int value, double at) {
    Owners owners;
    for (PostedGrid& each : posted_) {
      if (each.asked->began <= at && each.asked->may_count() && holds(each.extent, cell) &&
          value_of(each.serial, cell.x, cell.y) == value)
        owners.push_back(&each);
    }
    return owners;
  }

  /// Each of its cells has the grid's value, or the value of a grid that is not older or that this grid let
  /// pass.
  bool is_there(const PostedGrid& grid) const {
    bool all = true;
    for_each_cell(grid.extent, [&](const Extent& cell) {
      const auto found = has_.find(key_of(cell));
      all = all && found != has_.end() &&
            std::ranges::any_of(found->second.owners, [&](const PostedGrid* owner) {
              return !owner->is_before(grid) || lets_newer_pass(*owner);
            });
    });
    return all;
  }

  /// Whether `older`, perhaps on another lattice, was accepted after a part of a grid that covers it.
  bool is_under(const PostedGrid& grid, const PostedGrid& older) const {
    bool any = false;
    for_each_cell(grid.extent, [&](const Extent& cell) {
      const auto found = has_.find(key_of(cell));
      any = any || (overlap(cell, older.extent) && found != has_.end() && found->second.place < older.taken);
    });
    return any;
  }

  /// Counts the failures of the grid and of the grids that it may have replaced.
  bool lets_newer_pass(const PostedGrid& grid) const {
    int failures = grid.failures;
    for (const PostedGrid& older : posted_) {
      const bool may_be_replaced = &older != &grid && !grid.is_before(older) && !older.is_taken &&
                                   !older.is_refused && holds(grid.extent, older.extent);
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
  for (std::size_t i = 0; i < evidence.events.size(); ++i) {
    const Event& event = evidence.events[i];
    if (event.kind == Kind::NewRun && event.what != kSameMap) {
      for (auto& [name, grids] : names) grids.begin_run(i);
    }
    if (event.what != kMap) continue;
    std::vector<PostedGrid*>& sent = last_sent[event.request];
    if (event.kind == Kind::Replied) {
      for (PostedGrid* each : sent) each->answered(event);
    }
    if (event.kind != Kind::Taken && event.kind != Kind::Left) continue;
    sent.clear();
    if (!is_grid(event.says)) continue;
    sent = of(event.who).sent(event);
    if (event.kind == Kind::Taken) of(event.who).taken(event, i, broken);
  }
  for (const auto& [name, grids] : names) grids.check(name, broken);
}

}  // namespace adit::simulation
