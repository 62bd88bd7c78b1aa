// Grids that were sent before: by an earlier process, in another run, or to another Command Post.
#include <vector>

#include "forward/maps.hpp"

namespace adit::forward {

/// After a power cut the areas of earlier grids are unknown. The record that begins grids shows it.
void Maps::carry_on_grids(const journal::Carried& carried, bool ran_before) {
  queues::Canvases::Posted posted = carried.grids().value_or(queues::Canvases::Posted{});
  if (!carried.grids()) {
    const auto everywhere = queues::Extent::everywhere();
    const auto told =
        ran_before ? journal_.grids_posted(queues::Canvases::kAnyName, everywhere) : journal_.grids_begin();
    if (ran_before || !told) posted[queues::Canvases::kAnyName] = everywhere;
    are_grids_told_ = told.has_value();
  }
  queue_.canvases().carry_on(std::move(posted));
}

/// Journals posted areas, so that later processes know the cells that were never sent. False: not journaled,
/// do not accept the grid. If the start could not read the journal, it is left for the next process.
bool Maps::is_told(const icd::MapUpdate& update) {
  if (!update.is_grid()) return true;
  if (!are_grids_told_) {
    const auto everywhere = queues::Extent::everywhere();
    are_grids_told_ = journal_.grids_posted(queues::Canvases::kAnyName, everywhere).has_value();
    if (!are_grids_told_) return false;
  }
  const auto grows = queue_.canvases().grows(update);
  if (!grows) return true;
  if (!journal_.grids_posted(grows->first, grows->second)) return false;
  queue_.canvases().grown(*grows);
  return true;
}

/// False if maps go to another Command Post, whose statuses Adit does not read.
bool Maps::is_heard_from() const {
  return channel_.address() == address_text(settings_.command_post.mapping);
}

void Maps::heard() {
  if (!is_heard_from()) return;
  std::vector<const icd::MapUpdate*> under_way;
  for (const Place& place : {prepared_, following_}) {
    if (place) under_way.push_back(&place->waiting.map);
  }
  queue_.canvases().heard(under_way);
}

void Maps::change_run(dispatch::NextMap next) {
  points_.forget();
  pack_again();
  queues::Canvases& canvases = queue_.canvases();
  if (next == dispatch::NextMap::Empty && is_heard_from()) return canvases.begin_run();
  if (next == dispatch::NextMap::Earlier) return canvases.take_up_run();
  canvases.change_run();
}

void Maps::leads_elsewhere() {
  queue_.canvases().lead_to(channel_.address());
  pack_again();
}

/// Maps not in flight may cover old cells.
void Maps::pack_again() {
  put_back(following_);
  put_back(prepared_);
}

}  // namespace adit::forward
