// Start, life and end of the flow.
#include <algorithm>
#include <cmath>
#include <utility>

#include "forward/flow.hpp"
#include "host/random.hpp"
#include "host/service.hpp"
#include "spool/kept_message.hpp"

namespace adit::forward {
namespace {

/// Bytes of the runtime directory without maps: the journal with its compaction, rejected messages, and other
/// rooms' files.
std::uint64_t beside_maps(const settings::Settings& settings) {
  constexpr std::uint64_t kOthers = 8u << 20;
  return 4 * std::uint64_t{settings.queues.marker_bytes} + queues::RejectedMessages::kMostBytes + kOthers;
}

archive::Limits limits_of(const settings::Settings& settings) {
  return {.run = settings.runs.run_bytes, .all = settings.runs.all_bytes};
}

std::uint64_t seed() {
  std::uint64_t seed = 0;
  host::fill_random({reinterpret_cast<std::uint8_t*>(&seed), sizeof seed});
  return seed;
}

/// The newest time in the runs, by the stamp clock; 0: no run.
double newest_in(const ledger::Ledger& ledger) {
  double newest = 0;
  for (const dispatch::Run& run : ledger.runs()) newest = std::max({newest, run.began, run.heard});
  return newest;
}

/// Call after queued messages are restored, which the record counts.
void restore_counts(TrafficCounts& counts, const std::map<std::string, journal::Heard>& heard_before,
                    const loop::Loop& loop) {
  for (const auto& [robot, heard] : heard_before) {
    for (std::size_t kind = 0; kind < heard.kinds.size(); ++kind) {
      const auto [accepted, forwarded] = heard.kinds[kind];
      if (std::isnan(accepted)) continue;
      counts.restore({static_cast<Kind>(kind), robot}, time_of(loop, accepted), time_of(loop, forwarded));
    }
  }
}

}  // namespace

Flow::Flow(loop::Loop& loop, ledger::Ledger& ledger, const settings::Settings& settings, Tokens tokens,
           const Folders& folders, Told told)
    : loop_(loop),
      ledger_(ledger),
      upkeep_(loop, ledger),
      settings_(settings),
      tokens_(std::move(tokens)),
      told_(std::move(told)),
      random_(seed()),
      spool_(folders.runtime + kWaiting, beside_maps(settings)),
      writer_(loop),
      workers_(loop, 0),
      journal_(loop, folders.runtime + kJournal),
      clocks_(loop, journal_, folders.state, newest_in(ledger)),
      rejected_(loop, writer_, folders.runtime + kRejected),
      counts_([this] { changed(); }),
      servers_(loop),
      scoring_(loop, servers_, ledger, settings, tokens_.scoring, counts_, random_, journal_, clocks_),
      run_news_(settings),
      picture_(loop, workers_, [this] { changed(); }),
      maps_(loop, servers_, workers_, writer_, spool_, settings, tokens_.mapping, counts_, rejected_, random_,
            journal_, [this](icd::MapUpdate map) { picture_.forwarded(std::move(map)); }),
      telemetry_(loop, servers_, workers_, settings, tokens_.mapping, counts_, rejected_, random_, journal_,
                 delivered_),
      archive_(loop, folders.state),
      drained_(loop.timer([this] { drain(); })) {
  archive_.limit(limits_of(settings));
}

bool Flow::can_be_read(const std::string& runtime_folder) {
  return journal::Journal::can_be_read(runtime_folder + kJournal) &&
         spool::can_be_read(runtime_folder + kWaiting) && spool::can_be_read(runtime_folder + kRejected);
}

std::string Flow::put_aside() const {
  std::string all;
  for (const std::string& each :
       {spool_.put_aside(), rejected_.put_aside(), journal_.damage(), rejected_.missing()}) {
    if (!each.empty()) all += (all.empty() ? "" : "; ") + each;
  }
  return all;
}

void Flow::start() {
  carry_on();
  scoring_.start();
  telemetry_.start();
  has_started_ = true;
  picture_the_run();
}

void Flow::stand_by(const std::string& why) {
  standby_ = why;
  scoring_.stand_by();
  maps_.stand_by();
  telemetry_.stand_by();
}

/// Rates and stamps go on without a gap.
void Flow::carry_on() {
  journal::Carried carried = journal_.read();
  const bool is_first = !carried.clock();
  clocks_.carry_on(carried, host::boot());
  scoring_.carry_on(carried);
  maps_.carry_on(carried, clocks_.ran_before());
  telemetry_.carry_on(carried);
  restore(is_first);
  heard_before_ = carried.heard();
  restore_counts(counts_, heard_before_, loop_);
}

/// Messages in files. Without a journal the last sending is unknown: maps get new stamps, all requests wait.
void Flow::restore(bool is_first) {
  rejected_.restore();
  spool::Spool::Kept kept = spool_.read();
  if (is_first && !kept.empty()) {
    scoring_.hold_back();
    maps_.hold_back();
    telemetry_.hold_back();
  }
  for (spool::Spool::KeptMap& each : kept) {
    if (is_first) each.map.header().stamp = loop_.stamp_now();
  }
  maps_.restore(std::move(kept));
}

void Flow::settings_changed(const settings::Restarts& restarts, Tokens tokens) {
  tokens_ = std::move(tokens);
  archive_.limit(limits_of(settings_));
  spool_.leave_to_others(beside_maps(settings_));
  if (restarts.scoring)
    scoring_.endpoint_changed(tokens_.scoring);  // first: no more requests to the old endpoint
  if (restarts.mapping) maps_.endpoint_changed(tokens_.mapping);
  if (restarts.mapping) telemetry_.endpoint_changed(tokens_.mapping);
  scoring_.settings_changed();
  maps_.settings_changed();
  telemetry_.settings_changed();
}

void Flow::link_is_back() {
  scoring_.link_is_back();
  maps_.link_is_back();
  telemetry_.link_is_back();
}

void Flow::tick(loop::Writer& disk) {
  meter_.second(sent_bytes());
  scoring_.tick();
  clocks_.keep(disk, ledger_.known());
  if (!is_ending()) upkeep_.tick(disk);
  archive_.tick(seen());
}

KnownTimes Flow::known_times() const {
  return {.command_post = scoring_.channel().last().time_there(), .robots = clocks_.told_by_robots()};
}

/// Stamps, the ledger and earlier runs keep their times.
void Flow::wall_was_set(double seconds) {
  clocks_.wall_was_set();
  counts_.move(seconds);
  delivered_.move(seconds);
  picture_.move(seconds);
  archive_.move(seconds);
}

void Flow::end(std::function<void()> over) {
  if (is_ending()) return;
  ledger_.end_upkeep();
  ending_.begin(loop_.now());
  over_ = std::move(over);
  drain();
}

void Flow::drain() {
  if (ending_.is_over(loop_.now())) {
    over_();
    return archive_.write_now(seen());
  }
  drained_.call_at(loop_.now() + Ending::kStep);
  const bool scoring = scoring_.stop(), maps = maps_.stop(), telemetry = telemetry_.stop();
  const bool kept = maps_.all_kept() && rejected_.all_kept();
  if (!ending_.dismisses(loop_.now(), scoring && maps && telemetry, kept)) return;
  drained_.call_at(loop_.now() + Ending::kFlush);
  scoring_.dismiss();
}

}  // namespace adit::forward
