// What is known of the grids that were sent before: in a life before this one, in another run, and to another
// Command Post.
#include <vector>

#include "forward/maps.hpp"

namespace adit::forward {

/// After a power cut the journal is gone: then it is not known where grids were sent, if any were. That is
/// told by the record that begins them, for a life may end after each.
void Maps::carry_on_grids(const journal::Carried& carried, bool ran_before) {
  lanes::Canvases::Posted posted = carried.grids().value_or(lanes::Canvases::Posted{});
  if (!carried.grids()) {
    const auto everywhere = lanes::Extent::everywhere();
    const auto told =
        ran_before ? journal_.grids_posted(lanes::Canvases::kAnyName, everywhere) : journal_.grids_begin();
    if (ran_before || !told) posted[lanes::Canvases::kAnyName] = everywhere;
    are_grids_told_ = told.has_value();
  }
  lane_.canvases().carry_on(std::move(posted));
}

/// Records where grids are posted, so that a later process knows which cells cannot have been sent. False:
/// the journal cannot record it. The grid must not be accepted then: if the journal could not be read at the
/// start, the next process reads it as the process before left it.
bool Maps::is_told(const icd::MapUpdate& update) {
  if (!update.is_grid()) return true;
  if (!are_grids_told_) {
    const auto everywhere = lanes::Extent::everywhere();
    are_grids_told_ = journal_.grids_posted(lanes::Canvases::kAnyName, everywhere).has_value();
    if (!are_grids_told_) return false;
  }
  const auto grows = lane_.canvases().grows(update);
  if (!grows) return true;
  if (!journal_.grids_posted(grows->first, grows->second)) return false;
  lane_.canvases().grown(*grows);
  return true;
}

/// False while maps still go to another Command Post than the settings name: its statuses are not read.
bool Maps::is_heard_from() const {
  return channel_.address() == address_text(settings_.command_post.mapping);
}

void Maps::heard() {
  if (!is_heard_from()) return;
  std::vector<const icd::MapUpdate*> under_way;
  for (const Place& place : {prepared_, following_}) {
    if (place) under_way.push_back(&place->waiting.map);
  }
  lane_.canvases().heard(under_way);
}

void Maps::change_run(dispatch::NextMap next) {
  points_.forget();
  pack_again();
  lanes::Canvases& canvases = lane_.canvases();
  if (next == dispatch::NextMap::Empty && is_heard_from()) return canvases.begin_run();
  if (next == dispatch::NextMap::Earlier) return canvases.take_up_run();
  canvases.change_run();
}

void Maps::leads_elsewhere() {
  lane_.canvases().lead_to(channel_.address());
  pack_again();
}

/// What is not under way yet may hold what lay there before.
void Maps::pack_again() {
  put_back(following_);
  put_back(prepared_);
}

}  // namespace adit::forward
