#include "forward/markers.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include "codec/write.hpp"
#include "forward/states.hpp"

namespace adit::forward {
namespace {

/// Beyond this all trials restart.
constexpr std::size_t kMostTrials = 1000;

queues::MarkerBounds bounds_of(const settings::Queues& queues) {
  return {.per_message = queues.markers_per_message,
          .bytes_per_message = queues.marker_bytes_per_message,
          .bytes = queues.marker_bytes};
}

}  // namespace

Markers::Markers(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings,
                 TrafficCounts& counts, std::mt19937_64& random, journal::Journal& journal,
                 DeliveredScene& delivered, std::function<void()> came)
    : loop_(loop),
      counts_(counts),
      journal_(journal),
      delivered_(delivered),
      pace_(kUri, settings.command_post.rates.markers_hz, random, journal),
      queue_(bounds_of(settings.queues)),
      arrivals_(loop, workers, journal, queue_, counts, std::move(came)) {}

void Markers::carry_on(const journal::Carried& carried) {
  pace_.carry_on(carried, loop_.now());
  if (icd::MarkersUpdate markers = carried.markers(); !markers.markers.empty()) {
    counts_.accepted({Kind::Markers, ""}, 0, loop_.wall_now());
    queue_.add(std::move(markers), loop_.now());
  }
}

void Markers::settings_changed(const settings::Settings& settings) {
  queue_.keep_within(bounds_of(settings.queues));
  pace_.allow(settings.command_post.rates.markers_hz, loop_.now());
}

void Markers::endpoint_turned() {
  pace_.link_is_back();
  failed_ = 0;
  blame_ = {};
  trials_.clear();
}

/// In the journal the last one wins, so a deletion of all must precede queued markers.
bool Markers::send_again(icd::MarkersUpdate markers) {
  const auto deletes_all = [](const icd::Marker& marker) {
    return marker.action == icd::MarkerAction::DeleteAll;
  };
  const bool wipes = std::ranges::any_of(markers.markers, deletes_all);
  queues::MarkerChanges under_way;
  if (under_way_) {
    for (const icd::Marker& marker : under_way_->update.markers) under_way.apply(marker);
  }
  if (arrivals_.is_in_part() || (wipes && !under_way.empty())) return false;
  std::erase_if(markers.markers, [&](const icd::Marker& marker) {
    return queue_.says_more_than(marker) || under_way.says_more_than(marker);
  });
  if (markers.markers.empty()) return true;
  queues::start_lifetimes(markers.markers, loop_.stamp_now());
  icd::MarkersUpdate in_order = markers;
  if (wipes) std::ranges::copy(queue_.pending(), std::back_inserter(in_order.markers));
  if (!journal_.accepted(in_order)) return false;
  queue_.put_back({.update = std::move(markers), .accepted = loop_.now(), .updates = 1});
  return true;
}

Markers::Sent Markers::take() {
  auto waiting = queue_.take(loop_.stamp_now());
  if (!waiting) return nullptr;
  for (icd::Marker& marker : waiting->update.markers) {
    marker.header.stamp = pace_.next_stamp(marker.header.stamp.value_or(loop_.stamp_now()));
  }
  if (!waiting->update.markers.empty()) {
    pace_.keep_stamp(*waiting->update.markers.back().header.stamp);
  }
  if (!waiting->is_ahead) journal_.markers_sent(waiting->update);
  under_way_ = std::make_shared<const queues::QueuedMarkers>(std::move(*waiting));
  return under_way_;
}

icd::ChunkedBytes Markers::body_of(const queues::QueuedMarkers& markers) {
  return codec::write_markers_update(markers.update);
}

void Markers::passed(const queues::QueuedMarkers& markers) {
  failed_ = 0;
  blame_.passed("", loop_.now());
  if (markers.is_ahead) return;
  queue_.passed();
  if (trials_.empty()) return;
  for (const icd::Marker& marker : markers.update.markers) trials_.erase({marker.ns, marker.id});
}

void Markers::show(const Sent& markers) {
  to_show_ = markers;
  shown_ = 0;
}

bool Markers::show_some() {
  if (!to_show_) return false;
  const std::span<const icd::Marker> all = to_show_->update.markers;
  const auto some = all.subspan(shown_, std::min(all.size() - shown_, kAtOnce));
  delivered_.forwarded(some, loop_.wall_now());
  shown_ += some.size();
  if (shown_ == all.size()) to_show_.reset();
  return some.size() < all.size();
}

void Markers::put_back(const queues::QueuedMarkers& markers) {
  if (markers.is_ahead) return;
  journal_.markers_answered(false);
  queue_.put_back(markers);
}

bool Markers::is_on_trial(const queues::QueuedMarkers& markers) const {
  if (markers.update.markers.size() != 1) return false;
  const icd::Marker& marker = markers.update.markers.front();
  const auto trial = trials_.find({marker.ns, marker.id});
  return trial != trials_.end() && trial->second.strikes > 0;
}

bool Markers::is_to_blame(const queues::QueuedMarkers& markers, bool may_reject) {
  if (markers.is_ahead) return false;
  if (markers.update.markers.size() != 1) {
    // A marker that failed alone is still queued: it is at fault again.
    const bool narrow = ++failed_ >= States::kTriesTogether || !trials_.empty();
    if (narrow) pace_.forget_failures();
    if (!narrow) put_back(markers);
    return narrow;
  }
  const icd::Marker& marker = markers.update.markers.front();
  if (trials_.size() >= kMostTrials) trials_.clear();
  const bool to_blame = blame_.failed("", trials_[{marker.ns, marker.id}], loop_.now(), may_reject) ==
                        queues::Blame::Next::Reject;
  if (!to_blame) {
    journal_.markers_answered(false);
    queue_.put_behind(markers);
  }
  return to_blame;
}

bool Markers::give_up(const queues::QueuedMarkers& markers) {
  if (markers.is_ahead) return false;  // it has its own turn
  if (markers.update.markers.size() > 1) {
    journal_.markers_answered(false);
    queue_.put_back_narrower(markers);
    return false;
  }
  for (const icd::Marker& marker : markers.update.markers) trials_.erase({marker.ns, marker.id});
  return true;
}

}  // namespace adit::forward
