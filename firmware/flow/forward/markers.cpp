#include "forward/markers.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/write.hpp"
#include "icd/sentence.hpp"

namespace adit::forward {
namespace {

std::size_t bytes_of_all(const icd::MarkersUpdate& update) {
  std::size_t bytes = 0;
  for (const icd::Marker& marker : update.markers) bytes += icd::bytes_of(marker);
  return bytes;
}

constexpr std::string_view kMostThatWait = "queues.marker_bytes";

icd::Refusal no_memory() {
  return {icd::Status::ServiceUnavailable, "Adit has no memory for these markers; send them again later"};
}

}  // namespace

MarkerArrivals::MarkerArrivals(loop::Loop& loop, loop::Workers& workers, journal::Journal& journal,
                               queues::MarkerQueue& queue, TrafficCounts& counts)
    : loop_(loop),
      workers_(workers),
      journal_(journal),
      queue_(queue),
      counts_(counts),
      next_turn_(loop.timer([this] { run_step(next_step()); })) {}

void MarkerArrivals::accept(icd::MarkersUpdate update, queues::Upload upload, Done done) {
  queues::start_lifetimes(update.markers, loop_.stamp_now());
  arrivals_.push_back(
      {std::make_shared<icd::MarkersUpdate>(std::move(update)), std::move(upload), std::move(done)});
  if (arrivals_.size() == 1) run_step(&MarkerArrivals::begin);
}

MarkerArrivals::Step MarkerArrivals::next_step() const {
  if (!is_in_part()) return &MarkerArrivals::begin;
  return arrivals_.front().records.empty() ? &MarkerArrivals::add_part : &MarkerArrivals::keep;
}

bool MarkerArrivals::fail(Arrival& arrival, icd::Refusal why) {
  arrival.outcome = std::unexpected(std::move(why));
  return true;
}

void MarkerArrivals::end() {
  Arrival first = std::move(arrivals_.front());
  arrivals_.pop_front();
  if (!arrivals_.empty()) next_turn_.call_at(loop_.now());
  first.done(std::move(first.outcome));
}

bool MarkerArrivals::begin(Arrival& arrival) {
  if (overtaken_.remove_from(*arrival.update, arrival.upload) > 0 && arrival.update->markers.empty()) {
    counts_.count_accepted({TrafficKind::Markers, ""}, arrival.upload.bytes, loop_.wall_now());
    counts_.count_replaced({TrafficKind::Markers, ""}, 1);
    return true;
  }
  if (!queue_.has_room_for(*arrival.update) && !accept_known(arrival)) {
    return fail(
        arrival,
        {.status = icd::Status::TooManyRequests,
         .sentence = "not accepted: the queue of markers is full (queues.marker_bytes); send it again later",
         .setting = kMostThatWait});
  }
  if (bytes_of_all(*arrival.update) > kSmall) {
    make_records(arrival);
    return false;
  }
  arrival.records = journal::records_of(arrival.update->markers);
  return keep(arrival);
}

bool MarkerArrivals::accept_known(Arrival& arrival) {
  counts_.no_room({TrafficKind::Markers, ""}, loop_.wall_now());
  icd::MarkersUpdate known = queue_.queued_changes(*arrival.update);
  if (known.markers.empty() || !queue_.has_room_for(known)) return false;
  const std::size_t taken = known.markers.size(), all = arrival.update->markers.size();
  arrival.outcome = std::unexpected(
      icd::Refusal{icd::Status::TooManyRequests,
                   icd::sentence(taken, " of ", all,
                                 " markers were accepted, because they replace queued markers; the queue has "
                                 "no room for new markers (queues.marker_bytes); send them again later"),
                   all - taken, kMostThatWait});
  *arrival.update = std::move(known);
  return true;
}

void MarkerArrivals::make_records(const Arrival& arrival) {
  const auto made = std::make_shared<std::vector<std::string>>();
  workers_.submit(
      loop::Urgency::OnTheWay,
      [made, update = arrival.update] { *made = journal::records_of(update->markers); },
      [this, made] {
        arrivals_.front().records = std::move(*made);
        run_step(&MarkerArrivals::keep);
      });
}

bool MarkerArrivals::keep(Arrival& arrival) {
  if (arrival.records.empty()) return fail(arrival, no_memory());
  if (const auto kept = journal_.accepted_markers(arrival.records[arrival.stored]); !kept) {
    return fail(arrival, {icd::Status::ServiceUnavailable,
                          "not accepted: it cannot be stored: " + kept.error() + "; send it again later"});
  }
  arrival.is_kept = true;
  if (++arrival.stored < arrival.records.size()) {
    next_turn_.call_at(loop_.now());
    return false;
  }
  arrival.records = {};
  counts_.count_accepted({TrafficKind::Markers, ""}, arrival.upload.bytes, loop_.wall_now());
  overtaken_.record(*arrival.update, arrival.upload);
  if (arrival.update->markers.size() <= kPart) return add_part(arrival);
  next_turn_.call_at(loop_.now());
  return false;
}

bool MarkerArrivals::add_part(Arrival& arrival) {
  const std::span<icd::Marker> markers = arrival.update->markers;
  const auto part = markers.subspan(arrival.added, std::min(kPart, markers.size() - arrival.added));
  const auto invisible = static_cast<std::size_t>(std::ranges::count_if(part, icd::is_invisible));
  counts_.count_invisible(invisible);
  arrival.last = queue_.add_part(part, arrival.last);
  arrival.added += part.size();
  free_unneeded();
  if (arrival.added < markers.size()) {
    next_turn_.call_at(loop_.now());
    return false;
  }
  queue_.end_of_update(arrival.last, loop_.now());
  return true;
}

/// Up to tens of thousands of markers after a deletion.
void MarkerArrivals::free_unneeded() {
  auto needless = std::make_shared<std::vector<queues::MarkerChanges>>(queue_.needless());
  if (!needless->empty()) workers_.submit(loop::Urgency::CanWait, [needless] { needless->clear(); }, [] {});
}

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
                 DeliveredScene& delivered)
    : loop_(loop),
      counts_(counts),
      journal_(journal),
      delivered_(delivered),
      pace_(kUri, settings.command_post.rates.markers_hz, random, journal),
      queue_(bounds_of(settings.queues)),
      arrivals_(loop, workers, journal, queue_, counts) {}

void Markers::restore(const journal::HandoverState& carried) {
  pace_.restore(carried, loop_.now());
  if (icd::MarkersUpdate markers = carried.markers(); !markers.markers.empty()) {
    counts_.count_accepted({TrafficKind::Markers, ""}, 0, loop_.wall_now());
    queue_.add(std::move(markers), loop_.now());
  }
}

void Markers::on_settings_changed(const settings::Settings& settings) {
  queue_.set_bounds(bounds_of(settings.queues));
  pace_.allow(settings.command_post.rates.markers_hz, loop_.now());
}

void Markers::on_new_command_post() {
  pace_.on_link_up();
  failed_ = 0;
  blame_ = {};
  trials_.clear();
}

/// In the journal the last one wins, so a deletion of all must precede queued markers.
bool Markers::resend(icd::MarkersUpdate markers) {
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
    return queue_.supersedes(marker) || under_way.supersedes(marker);
  });
  if (markers.markers.empty()) return true;
  queues::start_lifetimes(markers.markers, loop_.stamp_now());
  icd::MarkersUpdate in_order = markers;
  if (wipes) std::ranges::copy(queue_.pending(), std::back_inserter(in_order.markers));
  if (!journal_.record_accepted(in_order)) return false;
  queue_.put_back({.update = std::move(markers), .accepted = loop_.now(), .updates = 1});
  return true;
}

Markers::Sent Markers::pop() {
  auto waiting = queue_.pop(loop_.stamp_now());
  if (!waiting) return nullptr;
  for (icd::Marker& marker : waiting->update.markers) {
    marker.header.stamp = pace_.next_stamp(marker.header.stamp.value_or(loop_.stamp_now()));
  }
  if (!waiting->update.markers.empty()) {
    pace_.keep_stamp(*waiting->update.markers.back().header.stamp);
  }
  if (!waiting->is_ahead) journal_.record_markers_sent(waiting->update);
  under_way_ = std::make_shared<const queues::QueuedMarkers>(std::move(*waiting));
  return under_way_;
}

icd::ChunkedBytes Markers::body_of(const queues::QueuedMarkers& markers) {
  return codec::write_markers_update(markers.update);
}

void Markers::on_passed(const queues::QueuedMarkers& markers) {
  failed_ = 0;
  blame_.on_passed("", loop_.now());
  if (markers.is_ahead) return;
  queue_.on_passed();
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
  delivered_.on_forwarded(some, loop_.wall_now());
  shown_ += some.size();
  if (shown_ == all.size()) to_show_.reset();
  return some.size() < all.size();
}

void Markers::put_back(const queues::QueuedMarkers& markers) {
  if (markers.is_ahead) return;
  journal_.record_markers_answered(false);
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
    const bool narrow = ++failed_ >= kTriesTogether || !trials_.empty();
    if (narrow) pace_.forget_failures();
    if (!narrow) put_back(markers);
    return narrow;
  }
  const icd::Marker& marker = markers.update.markers.front();
  if (trials_.size() >= kMostTrials) trials_.clear();
  const bool to_blame = blame_.on_failed("", trials_[{marker.ns, marker.id}], loop_.now(), may_reject) ==
                        queues::Blame::Decision::Reject;
  if (!to_blame) {
    journal_.record_markers_answered(false);
    queue_.requeue_last(markers);
  }
  return to_blame;
}

bool Markers::give_up(const queues::QueuedMarkers& markers) {
  if (markers.is_ahead) return false;  // it has its own turn
  if (markers.update.markers.size() > 1) {
    journal_.record_markers_answered(false);
    queue_.put_back_narrower(markers);
    return false;
  }
  for (const icd::Marker& marker : markers.update.markers) trials_.erase({marker.ns, marker.id});
  return true;
}

}  // namespace adit::forward
