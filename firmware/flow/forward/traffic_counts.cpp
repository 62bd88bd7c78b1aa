#include "forward/traffic_counts.hpp"

#include <cmath>

#include "icd/sentence.hpp"

namespace adit::forward {

Traffic traffic_of(const icd::MapUpdate& update) {
  return {update.is_grid() ? TrafficKind::Grid : TrafficKind::Cloud, icd::text_of(update.name)};
}

facts::ActivityRow& TrafficCounts::row(const Traffic& traffic) {
  const auto known = rows_.find(traffic);
  if (known != rows_.end()) return known->second;
  const bool full = rows_.size() >= kMostRows;
  facts::ActivityRow& made = rows_[full ? Traffic{traffic.kind, "(others)"} : traffic];
  made.kind = facts::kKinds[static_cast<std::size_t>(traffic.kind)];
  made.robot = full ? "(others)" : traffic.robot;
  return made;
}

void TrafficCounts::count_accepted(const Traffic& traffic, std::size_t bytes, api::Time now) {
  facts::ActivityRow& activity = row(traffic);
  ++activity.accepted;
  activity.last_accepted = now;
  activity.bytes_received = bytes;
  changed_();
}

void TrafficCounts::restore(const Traffic& traffic, api::Time accepted, api::Time forwarded) {
  facts::ActivityRow& activity = row(traffic);
  activity.last_accepted = std::max(accepted, activity.last_accepted.value_or(accepted));
  if (!std::isnan(forwarded)) activity.last_forwarded = forwarded;
}

void TrafficCounts::no_room(const Traffic& traffic, api::Time now) {
  facts::ActivityRow& activity = row(traffic);
  ++activity.no_room;
  activity.last_no_room = now;
  changed_();
}

void TrafficCounts::no_valid_point(const Traffic& traffic, std::size_t bytes, api::Time now) {
  ++row(traffic).no_valid_point;
  count_accepted(traffic, bytes, now);
}

void TrafficCounts::count_invisible(std::size_t markers) {
  if (markers == 0) return;
  row({TrafficKind::Markers, ""}).invisible += markers;
  changed_();
}

void TrafficCounts::rounded_to(const Traffic& traffic, queues::Precision precision) {
  row(traffic).precision = queues::kPrecisionWords[static_cast<std::size_t>(precision)];
}

void TrafficCounts::set_cloud_kind(const Traffic& traffic, queues::Clouds clouds) {
  if (traffic.kind == TrafficKind::Cloud)
    row(traffic).clouds = queues::kCloudsWords[static_cast<std::size_t>(clouds)];
}

void TrafficCounts::count_forwarded(const Traffic& traffic, std::size_t updates, std::size_t bytes,
                                    int status, api::Time now) {
  facts::ActivityRow& activity = row(traffic);
  ++activity.forwarded;
  ++delivered_;
  if (traffic.kind == TrafficKind::Cloud && updates > 1) activity.merged += updates - 1;
  activity.last_forwarded = now;
  activity.bytes_sent = bytes;
  activity.last_status = status;
  activity.last_sentence.clear();
  changed_();
}

void TrafficCounts::count_undelivered(const Traffic& traffic, DeliveryFailure how, int status,
                                      const std::string& sentence) {
  facts::ActivityRow& activity = row(traffic);
  if (how == DeliveryFailure::Throttled) ++activity.throttled;
  if (how == DeliveryFailure::Failed) ++activity.failed;
  if (how == DeliveryFailure::Refused) ++activity.refused_upstream;
  activity.last_status = status;
  activity.last_sentence = sentence;
  changed_();
}

void TrafficCounts::count_rejected(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& refusal,
                                   api::Time now) {
  api::RefusedCount& counted = refused_[{uri, refusal.status}];
  ++counted.count;
  counted.parts += refusal.parts;
  refusals_.push_front({.at = now,
                        .uri = std::string(icd::path_of(uri)),
                        .sender = sender.address,
                        .status = static_cast<int>(refusal.status),
                        .sentence = refusal.sentence,
                        .parts = refusal.parts,
                        .setting = std::string(refusal.setting)});
  if (refusals_.size() > kMostRefusals) refusals_.pop_back();
  changed_();
}

void TrafficCounts::move(double seconds) {
  for (auto& [traffic, activity] : rows_) {
    for (auto* const time : {&activity.last_accepted, &activity.last_forwarded, &activity.last_no_room}) {
      if (*time) **time += seconds;
    }
  }
  for (facts::RefusalRow& refusal : refusals_) refusal.at += seconds;
  changed_();
}

std::vector<api::RefusedCount> TrafficCounts::refused_counts() const {
  std::vector<api::RefusedCount> all;
  all.reserve(refused_.size());
  for (const auto& [what, counted] : refused_) {
    const auto& [uri, status] = what;
    all.push_back({.uri = std::string(icd::path_of(uri)),
                   .status = static_cast<int>(status),
                   .count = counted.count,
                   .parts = counted.parts});
  }
  return all;
}

}  // namespace adit::forward
