#include "forward/marker_arrivals.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

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
                               queues::MarkerQueue& queue, TrafficCounts& counts, std::function<void()> came)
    : loop_(loop),
      workers_(workers),
      journal_(journal),
      queue_(queue),
      counts_(counts),
      came_(std::move(came)),
      next_turn_(loop.timer([this] { go(next_step()); })) {}

void MarkerArrivals::take(icd::MarkersUpdate update, queues::Upload upload, Done done) {
  queues::start_lifetimes(update.markers, loop_.stamp_now());
  arrivals_.push_back(
      {std::make_shared<icd::MarkersUpdate>(std::move(update)), std::move(upload), std::move(done)});
  if (arrivals_.size() == 1) go(&MarkerArrivals::begin);
}

void MarkerArrivals::go(Step step) noexcept {
  if ((this->*step)(arrivals_.front())) end();
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
  came_();
}

bool MarkerArrivals::begin(Arrival& arrival) {
  if (overtaken_.remove_from(*arrival.update, arrival.upload) > 0 && arrival.update->markers.empty()) {
    counts_.accepted({Kind::Markers, ""}, arrival.upload.bytes, loop_.wall_now());
    counts_.replaced({Kind::Markers, ""}, 1);
    return true;
  }
  if (!queue_.has_room_for(*arrival.update) && !takes_some(arrival)) {
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

bool MarkerArrivals::takes_some(Arrival& arrival) {
  counts_.no_room({Kind::Markers, ""}, loop_.wall_now());
  icd::MarkersUpdate known = queue_.those_that_wait(*arrival.update);
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
        go(&MarkerArrivals::keep);
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
  counts_.accepted({Kind::Markers, ""}, arrival.upload.bytes, loop_.wall_now());
  overtaken_.record(*arrival.update, arrival.upload);
  if (arrival.update->markers.size() <= kPart) return add_part(arrival);
  next_turn_.call_at(loop_.now());
  return false;
}

bool MarkerArrivals::add_part(Arrival& arrival) {
  const std::span<icd::Marker> markers = arrival.update->markers;
  const auto part = markers.subspan(arrival.added, std::min(kPart, markers.size() - arrival.added));
  const auto invisible = static_cast<std::size_t>(std::ranges::count_if(part, icd::is_invisible));
  counts_.invisible(invisible);
  arrival.last = queue_.add_part(part, arrival.last);
  arrival.added += part.size();
  free_needless();
  if (arrival.added < markers.size()) {
    next_turn_.call_at(loop_.now());
    return false;
  }
  queue_.end_of_update(arrival.last, loop_.now());
  return true;
}

/// Up to tens of thousands of markers after a deletion.
void MarkerArrivals::free_needless() {
  auto needless = std::make_shared<std::vector<queues::MarkerChanges>>(queue_.needless());
  if (!needless->empty()) workers_.submit(loop::Urgency::CanWait, [needless] { needless->clear(); }, [] {});
}

}  // namespace adit::forward
