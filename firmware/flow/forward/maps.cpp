#include "forward/maps.hpp"

#include <algorithm>

#include "codec/write.hpp"
#include "dispatch/verdicts.hpp"
#include "forward/channel.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "pace/budget.hpp"

namespace adit::forward {
namespace {

using dispatch::MappingVerdict;

/// How often a map in flight is checked.
constexpr std::chrono::milliseconds kLookAtSending{10}, kLookAtConnecting{100};
/// Servers may close an idle request.
constexpr std::chrono::seconds kLongestHeldBack{2};
/// Some servers answer this with a page to a body above their limit.
constexpr int kBadRequest = static_cast<int>(icd::Status::BadRequest);

/// Bytes between two maps.
std::size_t slot_of(const settings::CommandPost& post) {
  const double bytes = static_cast<double>(pace::map_bytes_per_second(post.budget_mbit)) / post.rates.map_hz;
  return static_cast<std::size_t>(std::max(bytes, 1.0));
}

queues::Sender sender_of(const Traffic& traffic) {
  return {icd::RobotName::parse(traffic.robot), traffic.kind == Kind::Grid};
}

/// For queues::Blame.
std::string whose(const icd::MapUpdate& map) {
  return (map.is_grid() ? "grid " : "cloud ") + icd::text_of(map.name);
}

}  // namespace

Maps::Maps(loop::Loop& loop, uplink::Servers& servers, loop::Workers& workers, loop::Writer& writer,
           spool::Spool& spool, const settings::Settings& settings, std::optional<icd::BearerToken> token,
           TrafficCounts& counts, RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
           std::function<void(icd::MapUpdate)> taken)
    : loop_(loop),
      settings_(settings),
      counts_(counts),
      rejected_(rejected),
      taken_(std::move(taken)),
      channel_(loop, servers, "mapping",
               access_to_mapping(settings.command_post, std::move(token),
                                 pace::map_bytes_per_second(settings.command_post.budget_mbit)),
               [this] { pump(); }),
      pace_(icd::Uri::MapUpdate, settings.command_post.rates.map_hz, random, journal),
      wake_(loop.timer([this] { pump(); })),
      queue_(settings.queues.merge_bytes),
      store_(writer, spool),
      prepared_(loop, workers, settings, counts, pace_, queue_, store_,
                [this](bool is_done) { packed(is_done); }),
      accepted_(loop, workers, settings, counts, journal, queue_, store_, prepared_, [this] { pump(); }) {
  take_settings();
  queue_.canvases().lead_to(channel_.address());
}

void Maps::carry_on(const journal::Carried& carried, bool ran_before) {
  accepted_.carry_on(carried, ran_before);
  pace_.carry_on(carried, loop_.now());
}

void Maps::restore(spool::Spool::Kept kept) {
  const auto at_fault = std::ranges::stable_partition(
      kept, [](const spool::Spool::KeptMap& each) { return each.ends.faults < spool::Spool::Ends::kMost; });
  for (spool::Spool::KeptMap& each : at_fault) put_aside(std::move(each));
  kept.erase(at_fault.begin(), at_fault.end());
  accepted_.restore(std::move(kept));
}

/// Its file stays until the rejected messages have one.
void Maps::put_aside(spool::Spool::KeptMap kept) {
  store_.restored(kept.number);
  const Traffic traffic = traffic_of(kept.map);
  const std::size_t bytes = kept.map.data.bytes.size();
  const std::string why =
      icd::sentence("aditd ended ", kept.ends.faults, " times by a fault while it packed this map");
  counts_.accepted(traffic, bytes, time_of(loop_, kept.map.header().stamp.value_or(loop_.stamp_now())));
  counts_.not_taken(traffic, DeliveryFailure::Failed, 0, why);
  rejected_.add(std::move(kept.map), 0, why, bytes,
                {.let_go = [this, number = kept.number] { store_.forget({&number, 1}); }}, kept.bounds,
                kept.ends.faults);
}

void Maps::take_settings() {
  queue_.a_slot_carries(slot_of(settings_.command_post));
  queue_.merge_at_most(settings_.queues.merge_bytes);
  queue_.clouds_are(settings::by_robot(settings_.robots, &settings::Robot::clouds));
  queue_.precisions_are(settings::by_robot(settings_.robots, &settings::Robot::precision));
}

void Maps::settings_changed() {
  take_settings();
  prepared_.slot().allow(pace::map_bytes_per_second(settings_.command_post.budget_mbit));
  pace_.allow(settings_.command_post.rates.map_hz, loop_.now());
  pump();
}

void Maps::endpoint_changed(std::optional<icd::BearerToken> token) {
  const settings::CommandPost& post = settings_.command_post;
  channel_.lead_to(access_to_mapping(post, std::move(token), pace::map_bytes_per_second(post.budget_mbit)));
  channel_.give_up();
  pump();
}

void Maps::pump() noexcept {
  if (!stopping_ && channel_.turns()) {
    pace_.link_is_back();
    blame_ = {};
    ahead_ = {};
    prepared_.slot().forget_sizes();
    queue_.canvases().lead_to(channel_.address());
    prepared_.pack_again();
  }
  if (stopping_ || prepared_.is_packing() || !channel_.has_token()) return;
  go_on();
}

void Maps::go_on() {
  const loop::Instant now = loop_.now();
  const bool follows = channel_.busy();
  const Place& next = follows ? prepared_.following() : prepared_.first();
  if (next && next->is_under_way) return;
  if (next && next->packed.body.empty()) return prepared_.pack(next);
  if (next && must_split(*next)) {
    split(next);
    return go_on();
  }
  if (next && follows) return go_ahead(now);
  if (next) {
    if (now < starts()) return wake_.call_at(starts());
    if (channel_.claim_turn()) send(next);
    return;
  }
  if (queue_.count() == 0) return;
  const loop::Instant begin = begins_to_pack(now);
  if (now >= begin) return prepared_.prepare(follows, channel_.delivers());
  wake_.call_at(begin);
}

void Maps::packed(bool is_done) {
  if (is_done) return pump();
  pace_.failed(loop_.now());
  wake_.call_at(pace_.ready());
}

/// Of the next map, whose last byte is held back, except to a serial server.
loop::Instant Maps::starts() const {
  const pace::Span earliest = pace_.earliest();
  return std::max(earliest.first,
                  earliest.last - (channel_.is_serial() ? std::chrono::seconds{} : kLongestHeldBack));
}

/// Late, so that newer data replaces queued maps, but in time for its start or the end of the map in flight.
/// No packing while the link is down.
loop::Instant Maps::begins_to_pack(loop::Instant now) const {
  loop::Instant free = now;
  if (channel_.busy() && !prepared_.first()->arrived) {
    if (!channel_.connected()) return now + kLookAtConnecting;
    const std::size_t size = prepared_.first()->packed.body.size();
    free += prepared_.slot().transfer(size - std::min(size, channel_.sent_of_it()));
  }
  const loop::Instant begin = std::max(starts(), free) - prepared_.slot().lead();
  return begin <= now ? begin : std::max(begin, now + kLookAtSending);
}

void Maps::send(const Place& prepared) {
  const bool ahead = channel_.busy();
  prepared->last_byte_not_before = pace_.earliest().last;
  pace_.sent(loop_.now(), ahead);
  channel_.send(
      icd::Uri::MapUpdate, codec::kCbor, prepared->packed.body,
      [this, prepared](const uplink::Outcome& outcome) { answered(prepared, outcome); },
      prepared->last_byte_not_before);
  prepared->is_under_way = true;
  prepared->went_ahead = ahead;
  prepared->arrived.reset();
  wake_.call_at(loop_.now());  // for the following map
}

void Maps::answered(const Place& sent, const uplink::Outcome& outcome) {
  sent->is_under_way = false;
  classify(sent, outcome);
  pump();
}

void Maps::classify(const Place& sent, const uplink::Outcome& outcome) {
  if (const auto* answer = std::get_if<uplink::Answered>(&outcome)) return verdict(sent, *answer);
  pace_.failed(outcome, loop_.now());
  const std::string sentence = sentence_of(outcome);
  if (std::holds_alternative<uplink::InDoubt>(outcome) && is_cut_by_size(*sent))
    return send_smaller(sent, sent->waiting.cuts.at, 0, sentence);
  counts_.not_taken(traffic_of(sent->waiting.map), DeliveryFailure::Failed, 0, sentence);
  again(sent);
}

void Maps::taken(const Place& sent, const uplink::Answered& answered) {
  pace_.taken(answered.sent, loop_.now());
  prepared_.slot().left(sent->packed.body.size(), answered.sent, sent->last_byte_not_before);
  prepared_.slot().on_passed(sent->packed.body.size());
  icd::MapUpdate& map = sent->waiting.map;
  if (sent->begins_again) {
    counts_.forwarded(traffic_of(map), 0, sent->packed.body.size(), answered.status, loop_.wall_now());
    return again(sent);
  }
  ahead_.taken(sent->went_ahead);
  blame_.passed(whose(map), loop_.now());
  queue_.on_passed(queues::Sender::of(map));
  queue_.carried(queues::Sender::of(map), sent->packed.body.size());
  if (queues::next_piece(sent->waiting)) {
    counts_.forwarded(traffic_of(map), 0, sent->packed.body.size(), answered.status, loop_.wall_now());
    return prepared_.again(sent);
  }
  prepared_.leaves(sent);
  const std::size_t updates = sent->waiting.updates.size();
  if (sent->waiting.again) map.header().stamp = sent->waiting.again;
  // First: the writer works in order.
  for (const icd::MapUpdate* const said : queues::said_by(sent->waiting)) rejected_.taken(*said);
  store_.forget(sent->waiting.updates);
  counts_.forwarded(traffic_of(map), updates, sent->packed.body.size(), answered.status, loop_.wall_now());
  if (!map.is_grid()) counts_.rounded_to(traffic_of(map), sent->packed.precision);
  taken_(std::move(map));
}

void Maps::verdict(const Place& sent, const uplink::Answered& answered) {
  const loop::Instant now = loop_.now();
  const Traffic traffic = traffic_of(sent->waiting.map);
  const std::string sentence = sentence_of(answered, sent->packed.body.size());
  switch (dispatch::mapping_verdict(answered.status, dispatch::body_of(answered.body))) {
    case MappingVerdict::Taken:
      return taken(sent, answered);
    case MappingVerdict::Throttled:
      pace_.throttled(now, answered.retry_after);
      counts_.not_taken(traffic, DeliveryFailure::Throttled, answered.status, sentence);
      return again(sent);
    case MappingVerdict::Refused:
      pace_.taken(answered.sent, now);
      return give_up(sent, answered.status, sentence);
    case MappingVerdict::TooLarge:
      pace_.taken(answered.sent, now);
      return on_too_large(sent, answered, sentence);
    case MappingVerdict::Suspect:
      pace_.lost(now);
      if (answered.status == kBadRequest && is_cut_by_size(*sent))
        return send_smaller(sent, sent->waiting.cuts.at, answered.status, sentence);
      if (blame_.failed(whose(sent->waiting.map), sent->waiting.trial, now) == queues::Blame::Next::Reject)
        return give_up(sent, answered.status,
                       sentence + " (other maps were delivered, this map failed repeatedly)");
      counts_.not_taken(traffic, DeliveryFailure::Failed, answered.status, sentence);
      return again(sent);
    case MappingVerdict::Failing:
      pace_.failed(answered, now);
      counts_.not_taken(traffic, DeliveryFailure::Failed, answered.status, sentence);
      return again(sent);
  }
}

/// Its sender pays for the upload. If a proxy may have answered, it must fail as often as a map that fails
/// alone.
void Maps::on_too_large(const Place& sent, const uplink::Answered& answered, const std::string& sentence) {
  queues::QueuedMap& waiting = sent->waiting;
  const queues::Sender sender = queues::Sender::of(waiting.map);
  queue_.carried(sender, sent->packed.body.size());
  const std::size_t size = sent->packed.body.size();
  if (queues::can_split(waiting, size)) return send_smaller(sent, size, answered.status, sentence);
  prepared_.slot().on_too_large(size);
  const bool is_page = dispatch::body_of(answered.body) == dispatch::Body::Other;
  if (!is_page) return give_up(sent, answered.status, sentence);
  const auto next = blame_.failed(whose(waiting.map), waiting.trial, loop_.now());
  queue_.on_too_large(sender, waiting.trial);
  if (next == queues::Blame::Next::Reject) return give_up(sent, answered.status, sentence);
  counts_.not_taken(traffic_of(waiting.map), DeliveryFailure::Failed, answered.status, sentence);
  again(sent);
}

/// The endpoint would not accept it.
bool Maps::must_split(const PreparedMap& prepared) const {
  const std::size_t size = prepared.packed.body.size();
  return !prepared_.slot().fits(size) && queues::can_split(prepared.waiting, size);
}

/// Of two maps in flight the bytes that had left are not known. A map that cannot be split is retried,
/// because a fault of the link is never a reason to reject it.
bool Maps::is_cut_by_size(PreparedMap& sent) {
  const std::size_t size = sent.packed.body.size();
  if (size < queues::Cuts::kLeastBody || !queues::can_split(sent.waiting, size)) return false;
  if (sent.went_ahead || channel_.busy()) return false;
  return sent.waiting.cuts.check(channel_.sent_of_it(), counts_.delivered_count());
}

/// A message that ended after so many bytes was too large.
void Maps::send_smaller(const Place& sent, std::size_t bytes, int status, const std::string& sentence) {
  counts_.not_taken(traffic_of(sent->waiting.map), DeliveryFailure::Failed, status,
                    sentence + "; it is sent in smaller messages");
  prepared_.slot().on_too_large(std::min(bytes, sent->packed.body.size()));
  ahead_.failed(false);
  split(sent);
}

/// A single cloud or grid goes on in pieces within the limit.
void Maps::split(const Place& place) {
  queues::QueuedMap& waiting = place->waiting;
  if (place == prepared_.first()) prepared_.put_back_following();
  if (!waiting.parts.empty()) {
    queue_.put_back_halves(waiting);
  } else {
    const std::size_t size = place->packed.body.size();
    std::size_t pieces = 2;
    while (!prepared_.slot().fits(size / pieces)) ++pieces;
    queues::shrink(waiting, pieces);
    store_.forget(queue_.put_back(waiting));
  }
  prepared_.leaves(place);
}

void Maps::again(const Place& sent) {
  ahead_.failed(sent->went_ahead || channel_.busy());
  prepared_.again(sent);
}

/// Parts of a merged or stitched map are tried separately.
void Maps::give_up(const Place& sent, int status, const std::string& sentence) {
  ahead_.failed(false);
  queues::QueuedMap& waiting = sent->waiting;
  counts_.not_taken(traffic_of(waiting.map), DeliveryFailure::Refused, status, sentence);
  if (waiting.again) waiting.map.header().stamp = waiting.again;
  if (waiting.parts.empty()) {
    rejected_.add(waiting.map, status, sentence, waiting.map.data.bytes.size(),
                  {.let_go = [this, numbers = waiting.updates] { store_.forget(numbers); }}, waiting.bounds);
    return prepared_.leaves(sent);
  }
  if (sent == prepared_.first()) prepared_.put_back_following();
  queue_.put_back_apart(waiting);
  prepared_.leaves(sent);
}

/// False if maps go to another Command Post, whose statuses Adit does not read.
bool Maps::is_heard_from() const {
  return channel_.address() == address_text(settings_.command_post.mapping);
}

void Maps::heard() {
  if (!is_heard_from()) return;
  std::vector<const icd::MapUpdate*> under_way;
  for (const Place& place : {prepared_.first(), prepared_.following()}) {
    if (place) under_way.push_back(&place->waiting.map);
  }
  queue_.canvases().heard(under_way);
}

void Maps::change_run(dispatch::NextMap next) {
  prepared_.pack_again();
  queues::Canvases& canvases = queue_.canvases();
  if (next == dispatch::NextMap::Empty && is_heard_from()) return canvases.begin_run();
  if (next == dispatch::NextMap::Earlier) return canvases.take_up_run();
  canvases.change_run();
}

void Maps::link_is_back() {
  pace_.link_is_back();
  channel_.hurry();
  pump();
}

bool Maps::stop() {
  stand_by();
  return !channel_.busy();
}

std::size_t Maps::waiting(const Traffic& traffic) const {
  return queue_.count(sender_of(traffic)) + prepared_.of(traffic).size();
}

std::optional<loop::Instant> Maps::waits_since(const Traffic& traffic) const {
  std::optional<loop::Instant> oldest = queue_.oldest(sender_of(traffic));
  for (const PreparedMap* prepared : prepared_.of(traffic)) {
    oldest = std::min(oldest.value_or(prepared->waiting.accepted), prepared->waiting.accepted);
  }
  return oldest;
}

namespace {

/// A connection for the next map is made so long before it may start, and the end of the one before is looked
/// for so often from then on: the link is idle in between.
constexpr std::chrono::milliseconds kGetReady{50}, kLookForEnd{2};

/// A Command Post may read both at the same time, and then check the small one before a large one that
/// arrived first. Its stamp would run backward. A slow one reads so many bytes of a map's data in a second.
constexpr double kReads = 20e6;

loop::Duration reading_takes(const icd::MapUpdate& map) {
  return std::chrono::duration_cast<loop::Duration>(
      std::chrono::duration<double>(static_cast<double>(map.data.raw_size) / kReads));
}

}  // namespace

/// Once the one that is under way has arrived; it is looked for when the next may start, and not before.
void Maps::go_ahead(loop::Instant now) {
  if (!may_go_ahead(now)) return;
  PreparedMap& first = *prepared_.first();
  const std::size_t size = first.packed.body.size(), left = size - std::min(size, channel_.sent_of_it());
  if (!first.arrived && left > 0)
    return wake_.call_at(now + std::max<loop::Duration>(prepared_.slot().transfer(left) / 2, kLookAtSending));
  if (now < starts() - kGetReady) return wake_.call_at(starts() - kGetReady);
  channel_.get_ready();
  const auto arrived = first.arrived ? std::nullopt : channel_.has_arrived();
  if (arrived) {
    first.arrived = arrived->last;
    pace_.left(*arrived);
  }
  loop::Instant begin = starts();
  if (first.arrived) begin = std::max(begin, *first.arrived + reading_takes(first.waiting.map));
  if (first.arrived && channel_.can_go_ahead() && now >= begin) return send(prepared_.following());
  wake_.call_at(std::max(begin, now + kLookForEnd));
}

/// If not, the answer to the one that is under way is awaited.
bool Maps::may_go_ahead(loop::Instant now) const {
  const PreparedMap& first = *prepared_.first();
  const queues::Pipelining::Before before{
      .map = first.waiting, .arrived = first.arrived.value_or(now), .went_ahead = first.went_ahead};
  return first.is_under_way && !channel_.is_serial() && pace_.may_go_ahead(now) &&
         ahead_.may_go(prepared_.following()->waiting, before, now);
}

}  // namespace adit::forward
