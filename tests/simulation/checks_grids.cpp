// GridArrived: replays the cells of all grids that the Command Post took.
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

/// A grid that failed so often at the Command Post lets newer ones pass, to see whether they can.
constexpr int kInPlace = 3;
constexpr int kNoValue = 255;

/// A grid that was posted, and what became of it.
struct PostedGrid {
  const Asked* asked;
  std::int64_t serial;
  Extent extent;
  std::size_t taken = 0;    // the last event by which it was; 0: none
  int failures = 0;         // answers of 5xx to it
  bool is_taken = false;    // as an answer said
  bool is_refused = false;  // it is rejected, and follows later at the operator's word

  void answered(const Event& reply) {
    if (reply.status >= 500) ++failures;
    is_taken = is_taken || (reply.status == 200 && reply.who.empty());
    is_refused = is_refused || reply.status == 422;
  }
  bool is_before(const PostedGrid& other) const { return asked->ended < other.asked->began; }
};

/// Whether `size` cells from `begin`, in half cells, lie within those.
bool lies_within(int begin, int size, int outer_begin, int outer_size) {
  const int halves = begin - outer_begin;
  return halves >= 0 && halves % 2 == 0 && halves / 2 + size <= outer_size;
}

/// ICD 6.3.1: whether `outer` says all that `inner` said, if it is newer.
bool holds(const Extent& outer, const Extent& inner) {
  return outer.centimetres == inner.centimetres && lies_within(inner.x, inner.width, outer.x, outer.width) &&
         lies_within(inner.y, inner.height, outer.y, outer.height);
}

/// Whether they have any place in common.
bool overlap(const Extent& a, const Extent& b) {
  const auto one = [&](int a_begin, int a_size, int b_begin, int b_size) {
    return a_begin * a.centimetres < (b_begin + 2 * b_size) * b.centimetres &&
           b_begin * b.centimetres < (a_begin + 2 * a_size) * a.centimetres;
  };
  return one(a.x, a.width, b.x, b.width) && one(a.y, a.height, b.y, b.height);
}

/// Gives each cell of it as an extent of its own, row by row.
template <class Visit>
void for_each_cell(const Extent& extent, Visit visit) {
  for (int row = 0; row < extent.height; ++row) {
    for (int column = 0; column < extent.width; ++column)
      visit(Extent{extent.centimetres, extent.x + 2 * column, extent.y + 2 * row, 1, 1});
  }
}

/// The grids of one name, and what the Command Post has of them. What two Command Posts have is taken
/// together where an operator `switches` between them: then a cell that one of them lacks is not missed. Nor
/// is one that was sent by a life of which the box knows nothing. What was sent in an earlier run may be
/// missed, for a run begins with an empty map.
class GridsOfOneName {
 public:
  explicit GridsOfOneName(bool has_more_maps) : has_more_maps_(has_more_maps) {}
  void begin_run(std::size_t place) { run_began_ = place; }
  void post(const Asked& asked, const Item& item) {
    posted_.push_back({&asked, item.serial, Extent::from(item.says)});
  }

  /// A grid left, or was taken: those that were posted and are in it.
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
      // A grid of an earlier run has a gap's value there by chance.
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
      broken.push_back(icd::sentence("GridArrived: cells that nobody posted were taken from '", event.who,
                                     "' at ", event.at));
  }

  void check(const std::string& name, Broken& broken) const {
    for (const PostedGrid& grid : posted_) {
      if (!grid.asked->accepted()) continue;
      if (!is_there(grid)) {
        broken.push_back(
            icd::sentence("GridArrived: ", name, "'s ", grid.serial,
                          " was answered 200, and the Command Post has older cells there, or none"));
      }
      for (const PostedGrid& older : posted_) {
        const bool may_be_over = older.taken > 0 && older.is_before(grid) &&
                                 overlap(older.extent, grid.extent) && !lets_newer_pass(older);
        if (!may_be_over || !is_under(grid, older)) continue;
        broken.push_back(icd::sentence("GridArrived: ", name, "'s ", older.serial, " lies over its newer ",
                                       grid.serial, ", for it was taken last"));
      }
    }
  }

 private:
  /// Those that have that value there, of which one is the cell's.
  using Owners = std::vector<PostedGrid*>;
  struct Message {
    Extent extent;
    std::vector<PostedGrid*> within;  // that lie within it
    std::vector<Owners> cells;
  };
  struct Has {
    std::size_t place = 0;  // of the event by which it was taken
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

  /// Where a message has gaps, not all that lies within it is in it, and a gap may have its value by chance.
  /// Of what is in it each cell is its own, or of one that is no older, also where that has replaced it.
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

  /// Those that have that value there, also where they do not lie within the message: what was sent last may
  /// be sent with what lies about it.
  Owners owners_of(const Extent& cell, int value, double at) {
    Owners owners;
    for (PostedGrid& each : posted_) {
      if (each.asked->began <= at && each.asked->may_count() && holds(each.extent, cell) &&
          value_of(each.serial, cell.x, cell.y) == value)
        owners.push_back(&each);
    }
    return owners;
  }

  /// Each of its cells is its own, or one that is no older; or of one that let it pass.
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

  /// Whether `older`, which may be of another lattice, was taken after some of what is over it.
  bool is_under(const PostedGrid& grid, const PostedGrid& older) const {
    bool any = false;
    for_each_cell(grid.extent, [&](const Extent& cell) {
      const auto found = has_.find(key_of(cell));
      any = any || (overlap(cell, older.extent) && found != has_.end() && found->second.place < older.taken);
    });
    return any;
  }

  /// Its failures count with those of what it may have replaced.
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
  std::size_t run_began_ = 0;  // by which event
  std::deque<PostedGrid> posted_;
  std::map<Key, Has> has_;
};

/// A life that could write nothing down, and a power cut: where it was the life's end the next one holds
/// itself for the first, and where it was before, this one knows nothing of what the earlier ones sent. A
/// life between them that ended as it began has written nothing down, either.
bool knows_nothing(const Evidence& evidence) {
  constexpr double kTooShort = 1;         // seconds
  std::set<std::int64_t> unwritten, cut;  // lives
  std::map<std::int64_t, double> length;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Said && event.text.contains("stamps may run backward"))
      unwritten.insert(event.life);
    if (event.kind == Kind::PowerCut) cut.insert(event.serial);
    if (event.kind == Kind::Begins) length[event.life] = -event.at;
    if (event.kind == Kind::Ended) length[event.life] += event.at;
  }
  return std::ranges::any_of(unwritten, [&](std::int64_t life) {
    if (cut.contains(life - 1)) return true;
    std::int64_t last = life;
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
