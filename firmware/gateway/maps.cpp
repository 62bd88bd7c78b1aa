#include "gateway/maps.hpp"

#include <algorithm>

#include "codec/write.hpp"
#include "dispatch/turn.hpp"
#include "gateway/upstream_answer.hpp"
#include "host/log.hpp"
#include "pace/budget.hpp"
#include "pack/pack.hpp"

namespace adit::gateway {
namespace {

using dispatch::MappingVerdict;

/// Packing begins early by what it took last time, but not so early that much newer data could not replace
/// it.
constexpr std::chrono::milliseconds kLongestLead{500};

}  // namespace

Maps::Maps(loop::Loop& loop, loop::Workers& workers, const Spool& spool, const settings::Settings& settings,
           std::optional<icd::BearerToken> token, Record& record, std::mt19937_64& random,
           std::function<void(icd::MapUpdate)> taken)
    : loop_(loop),
      workers_(workers),
      spool_(spool),
      settings_(settings),
      record_(record),
      taken_(std::move(taken)),
      channel_(loop, "mapping",
               endpoint_of(settings.command_post, settings.command_post.mapping,
                           pace::map_bytes_per_second(settings.command_post.budget_mbit)),
               std::move(token), settings.command_post.timeouts.mapping_answer),
      pace_(settings.command_post.rates.map_hz, random),
      wake_(loop.timer([this] { pump(); })),
      lane_(settings.queues.merge_bytes) {}

icd::Checked<void> Maps::take(icd::MapUpdate update, std::size_t bytes_received) {
  if (lane_.count() > 0 && lane_.bytes() + update.data.bytes.size() > settings_.queues.map_bytes) {
    return std::unexpected(icd::Refusal{
        icd::Status::TooManyRequests, std::to_string(lane_.count()) + " maps of " +
                                          std::to_string(lane_.bytes() >> 20) +
                                          " MiB wait already; this one was not taken, send it again later"});
  }
  record_.accepted(traffic_of(update), bytes_received, loop_.stamp_now());
  const std::uint64_t number = ++numbers_;
  keep(number, update, add(number, update));
  pump();
  return {};
}

void Maps::restore(std::uint64_t number, icd::MapUpdate update) {
  numbers_ = std::max(numbers_, number);
  record_.accepted(traffic_of(update), update.data.bytes.size(), loop_.stamp_now());
  forget(add(number, std::move(update)));
  pump();
}

/// The numbers of the maps that this one replaced.
std::vector<std::uint64_t> Maps::add(std::uint64_t number, icd::MapUpdate update) {
  const Traffic traffic = traffic_of(update);
  needed_.insert(number);
  auto replaced = lane_.add(number, std::move(update), loop_.now());
  record_.replaced(traffic, replaced.size());
  return replaced;
}

/// What it replaced is forgotten once it is kept itself.
void Maps::keep(std::uint64_t number, const icd::MapUpdate& update, std::vector<std::uint64_t> replaced) {
  ++being_kept_;
  workers_.submit([&spool = spool_, number, update] { spool.keep(number, update); },
                  [this, number, replaced = std::move(replaced)] {
                    --being_kept_;
                    if (!needed_.contains(number)) spool_.forget(number);
                    forget(replaced);
                  });
}

void Maps::forget(const std::vector<std::uint64_t>& numbers) {
  for (const std::uint64_t number : numbers) {
    needed_.erase(number);
    spool_.forget(number);
  }
}

/// The map under way needs no more care.
void Maps::done() {
  forget(prepared_->waiting.updates);
  prepared_.reset();
}

void Maps::pump() {
  if (stopping_ || preparing_ || channel_.busy() || !channel_.has_token()) return;
  const loop::Instant now = loop_.now();
  if (prepared_) {
    if (now >= pace_.ready()) return send();
    wake_.call_at(pace_.ready());
    return;
  }
  if (lane_.count() == 0) return;
  const loop::Instant begin = pace_.ready() - std::min<loop::Duration>(packing_took_, kLongestLead);
  if (now >= begin) return prepare();
  wake_.call_at(begin);
}

void Maps::prepare() {
  auto waiting = lane_.take();
  if (!waiting) return;
  waiting->map.header().stamp = stamps_.next(waiting->map.header().stamp.value_or(loop_.stamp_now()));
  prepared_ = std::make_shared<Prepared>(Prepared{std::move(*waiting), {}});
  preparing_ = true;
  const loop::Instant began = loop_.now();
  workers_.submit(
      [prepared = prepared_] { prepared->body = codec::write_map_update(pack::pack(prepared->waiting.map)); },
      [this, began] {
        preparing_ = false;
        packing_took_ = loop_.now() - began;
        pump();
      });
}

void Maps::send() {
  pace_.sent(loop_.now());
  channel_.send(icd::Uri::MapUpdate, codec::kCbor, prepared_->body,
                [this](uplink::Outcome outcome) { answered(std::move(outcome)); });
}

void Maps::answered(uplink::Outcome outcome) {
  if (const auto* answer = std::get_if<uplink::Answered>(&outcome)) {
    verdict(*answer);
  } else {
    pace_.failed(loop_.now());
    record_.not_taken(traffic_of(prepared_->waiting.map), NotTaken::Failed, 0, sentence_of(outcome));
    again();
  }
  pump();
}

void Maps::verdict(const uplink::Answered& answered) {
  const loop::Instant now = loop_.now();
  const Traffic traffic = traffic_of(prepared_->waiting.map);
  switch (dispatch::mapping_verdict(answered.status)) {
    case MappingVerdict::Taken:
      pace_.taken(now);
      record_.forwarded(traffic, prepared_->waiting.updates.size(), prepared_->body.size(), answered.status,
                        loop_.stamp_now());
      taken_(std::move(prepared_->waiting.map));
      return done();
    case MappingVerdict::Throttled:
      pace_.throttled(now, answered.retry_after);
      record_.not_taken(traffic, NotTaken::Throttled, answered.status, sentence_of(answered));
      return again();
    case MappingVerdict::Refused:
      pace_.taken(now);
      return give_up(answered.status, sentence_of(answered));
    case MappingVerdict::Failing:
      pace_.failed(now);
      record_.not_taken(traffic, NotTaken::Failed, answered.status, sentence_of(answered));
      if (answered.status != dispatch::kHandlerFailed) return again();
      const std::uint64_t number = prepared_->waiting.updates.front();
      tries_ = std::exchange(tried_, number) == number ? tries_ + 1 : 1;
      if (tries_ < dispatch::kMostTries) return again();
      tries_ = 0;
      return give_up(answered.status, sentence_of(answered) + " (given up after " +
                                          std::to_string(dispatch::kMostTries) + " tries)");
  }
}

void Maps::again() {
  lane_.put_back(std::move(prepared_->waiting));
  prepared_.reset();
}

/// A map that will not be taken; of a merged cloud each part is tried by itself.
void Maps::give_up(int status, const std::string& sentence) {
  const Traffic traffic = traffic_of(prepared_->waiting.map);
  host::log(host::Level::Warning, "the Command Post refused a map",
            {{"robot", traffic.robot}, {"status", std::to_string(status)}, {"why", sentence}});
  record_.not_taken(traffic, NotTaken::Refused, status, sentence);
  if (prepared_->waiting.parts.empty()) return done();
  lane_.put_back_apart(std::move(prepared_->waiting));
  prepared_.reset();
}

void Maps::link_is_back() {
  pace_.link_is_back();
  channel_.hurry();
  pump();
}

bool Maps::stop() {
  stopping_ = true;
  return !channel_.busy() && being_kept_ == 0;
}

std::size_t Maps::waiting(const Traffic& traffic) const {
  const auto of_it = [&](const lanes::WaitingMap& waiting) { return traffic_of(waiting.map) == traffic; };
  return static_cast<std::size_t>(std::ranges::count_if(lane_.waiting(), of_it)) +
         (prepared_ && of_it(prepared_->waiting) ? 1 : 0);
}

}  // namespace adit::gateway
