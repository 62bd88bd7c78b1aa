#include "forward/flow.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "alarms/arrival.hpp"
#include "forward/channel.hpp"
#include "host/log.hpp"
#include "host/random.hpp"
#include "host/service.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "intake/answer.hpp"
#include "spool/kept_message.hpp"

namespace adit::forward {

bool Ending::dismisses(loop::Instant now, bool quiet, bool kept) {
  icd::require(has_begun());
  const loop::Instant answers_by = *began_ + kAnswers;
  const bool may_end = kept || now >= answers_by + kKeepWithin;
  dismissed_ = may_end && (quiet || now >= answers_by);
  return dismissed_;
}

bool Ending::is_over(loop::Instant now) const {
  icd::require(has_begun());
  return dismissed_ || now >= *began_ + kAnswers + 2 * kKeepWithin;
}

void LedgerUpkeep::tick(loop::Writer& disk) {
  if (loop_.now() < at_) return;
  auto work = ledger_.upkeep();
  if (!work) return;
  at_ = loop_.now() + kEvery;  // in case of failure
  const auto result =
      std::make_shared<ledger::Result<void>>(std::unexpected(ledger::Error{.what = "an exception"}));
  disk.submit([work = std::move(work), result] { *result = work(); }, [this, result] { on_done(*result); });
}

void LedgerUpkeep::on_done(const ledger::Result<void>& result) {
  ledger_.on_upkeep_done(result);
  if (result) at_ = loop_.now();
  const std::string why = result ? "" : result.error().what;
  if (std::exchange(trouble_, why) != why && !result)
    host::log(host::Level::Warning, "the ledger has no room in reserve", {{"why", why}});
}

RunNews::Change RunNews::update(const dispatch::Reports& reports) {
  const dispatch::Run& run = reports.run();
  const std::int64_t before = std::exchange(run_, run.number);
  const bool is_heard = update_clock(run);
  if (before == 0) return Change::FirstLook;
  if (before == run.number) {
    const bool is_likely = is_heard && is_by_settings(run) && dispatch::can_show_other_run(run);
    return is_likely ? Change::LikelyAnother : Change::None;
  }
  next_map_ = next_map_after(before, reports);
  return Change::Another;
}

/// Runs may have begun before this process or before a change of the Command Post.
dispatch::NextMap RunNews::next_map_after(std::int64_t before, const dispatch::Reports& reports) const {
  const dispatch::Run* const known = reports.runs().find(before);
  // The run goes on although another one seemed to begin.
  if (reports.runs().can_be(before, reports.run().number)) return dispatch::NextMap::MayBeTheSame;
  const bool is_here = known != nullptr && reports.runs().is_here(before) && is_by_settings(reports.run());
  return is_here ? dispatch::next_map(*known, reports.run()) : dispatch::NextMap::MayBeTheSame;
}

/// The present run is at the Command Post in the settings.
bool RunNews::is_by_settings(const dispatch::Run& run) const {
  return run.post == address_text(settings_.command_post.scoring);
}

/// True if the clock of the status has changed.
bool RunNews::update_clock(const dispatch::Run& run) {
  const auto& clock = run.status_clock;
  const double shows = clock ? clock->shows : 0;
  return std::exchange(clock_shown_, shows) != shows;
}

namespace {

queues::Upload upload_of(const intake::Sender& sender) {
  return {.address = sender.address,
          .bytes = sender.bytes,
          .began = sender.began,
          .ended = sender.ended,
          .overlaps = sender.overlaps};
}

}  // namespace

std::shared_ptr<intake::MapArrival> Flow::begin_map() {
  return maps_.begin_map([this](icd::MapUpdate update, const intake::Sender& sender,
                                std::shared_ptr<spool::MapFile> file,
                                std::function<void(icd::Checked<void>)> done) {
    if (!standby_.empty()) return done(icd::refuse(icd::Status::ServiceUnavailable, standby_));
    accept(std::move(update), sender, std::move(file), std::move(done));
  });
}

void Flow::accept(icd::MapUpdate update, const intake::Sender& sender, std::shared_ptr<spool::MapFile> file,
                  std::function<void(icd::Checked<void>)> done) {
  if (update.name) callbacks_.on_posted(update.name->text());
  const queues::Upload upload = upload_of(sender);
  clocks_.stamp(update, upload);
  maps_.accept(std::move(update), upload, std::move(file), std::move(done));
}

icd::Checked<void> Flow::accept(icd::StateUpdate update, const intake::Sender& sender) {
  if (!standby_.empty()) return icd::refuse(icd::Status::ServiceUnavailable, standby_);
  for (const icd::NamedPose& pose : update.poses) callbacks_.on_posted(pose.name.text());
  ADIT_TRY(telemetry_.has_room_for(update));
  return telemetry_.accept(clocks_.stamp_poses(update, upload_of(sender)), sender.bytes);
}

void Flow::accept(icd::MarkersUpdate update, const intake::Sender& sender, MarkerArrivals::Done done) {
  if (!standby_.empty()) return done(icd::refuse(icd::Status::ServiceUnavailable, standby_));
  queues::Upload upload = upload_of(sender);
  clocks_.stamp(update, upload);
  telemetry_.accept(std::move(update), std::move(upload), std::move(done));
}

void Flow::accept(const icd::ArtifactReport& report, const intake::Sender& sender,
                  std::shared_ptr<intake::Responder> responder) {
  if (!standby_.empty())
    return responder->answer(intake::error_answer(icd::Status::ServiceUnavailable, standby_));
  scoring_.accept(report, sender, std::move(responder));
}

void Flow::status(const intake::Sender&, std::shared_ptr<intake::Responder> responder) {
  if (!standby_.empty())
    return responder->answer(intake::error_answer(icd::Status::ServiceUnavailable, standby_));
  scoring_.status(std::move(responder));
}

std::string Tokens::strike_from(std::string sentence) const {
  for (const icd::BearerToken& token : all) token.strike_from(sentence);
  return sentence;
}

void Flow::record_dropped(icd::Uri uri, const intake::Sender& sender, const std::string& why) {
  host::log(host::Level::Info, "parts of a message rejected",
            {{"uri", std::string(icd::path_of(uri))},
             {"sender", sender.address},
             {"why", tokens_.strike_from(why)}});
}

/// gateway::Crowding logs wrong tokens together.
void Flow::on_rejected(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& callbacks) {
  icd::Refusal refusal = callbacks;
  refusal.sentence = tokens_.strike_from(callbacks.sentence);
  if (refusal.status != icd::Status::Unauthorized) {
    host::log(host::Level::Info, "message rejected",
              {{"uri", std::string(icd::path_of(uri))},
               {"sender", sender.address},
               {"status", std::to_string(static_cast<int>(refusal.status))},
               {"why", refusal.sentence}});
  }
  counts_.count_rejected(uri, sender, refusal, loop_.wall_now());
}

std::expected<void, std::string> Flow::change_rejected(std::uint64_t number, api::RejectedAction action) {
  if (is_ending()) return std::unexpected("the box is stopping and sends no more messages");
  if (!standby_.empty()) return std::unexpected(standby_);
  if (action == api::RejectedAction::Discard) return rejected_.discard(number);
  auto item = ADIT_TRY(rejected_.begin_resend(number));
  if (auto* const map = std::get_if<icd::MapUpdate>(&item.message)) {
    maps_.resend(
        std::move(*map), [this, number](bool kept) { return rejected_.finish_resend(number, kept); },
        item.bounds, item.faults);
  } else {
    rejected_.finish_resend(number, telemetry_.resend(item.message));
  }
  return {};
}

void Flow::on_changed() {
  update_picture();
  callbacks_.on_changed();
}

void Flow::update_picture() {
  if (!has_started_) return;
  switch (run_news_.update(reports())) {
    case RunNews::Change::None:
      return;
    case RunNews::Change::LikelyAnother:
      maps_.on_status();
      return;
    case RunNews::Change::FirstLook:
      break;
    case RunNews::Change::Another:
      archive_.end_run(archive_view());
      maps_.change_run(run_news_.next_map());
      telemetry_.change_run();
      delivered_.begin_run(loop_.wall_now());
      picture_.begin_run();
      break;
  }
  restore_run();
}

namespace {

/// `wall` is now. Rounded, because each view reads two clocks.
api::Time wall_time_of(const loop::Loop& loop, loop::Instant since, api::Time wall) {
  const api::Time at = wall - std::chrono::duration<double>(loop.now() - since).count();
  return std::round(at * 1000) / 1000;
}

}  // namespace

std::vector<facts::ActivityRow> Flow::activities() const {
  const api::Time now = loop_.wall_now();
  std::vector<facts::ActivityRow> rows;
  for (const auto& [traffic, counted] : counts_.rows()) {
    facts::ActivityRow& row = rows.emplace_back(counted);
    row.queued = is_map(traffic.kind) ? maps_.waiting(traffic) : telemetry_.waiting(traffic.kind);
    const auto since =
        is_map(traffic.kind) ? maps_.oldest_acceptance(traffic) : telemetry_.oldest_acceptance(traffic);
    if (since) row.behind_since = wall_time_of(loop_, *since, now);
    facts::set_ages(row, now);
  }
  return rows;
}

std::uint64_t Flow::sent_bytes() const {
  return scoring_.channel().bytes_sent() + maps_.channel().bytes_sent() + telemetry_.channel().bytes_sent();
}

namespace {

/// Bytes of the runtime directory without maps: journal and its compaction, rejected messages, other rooms.
std::uint64_t bytes_without_maps(const settings::Settings& settings) {
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
double newest_in(const std::vector<dispatch::Run>& runs) {
  double newest = 0;
  for (const dispatch::Run& run : runs) newest = std::max({newest, run.began, run.heard});
  return newest;
}

/// Call after queued messages are restored, which the record counts.
void restore_counts(TrafficCounts& counts, const std::map<std::string, journal::Heard>& heard_before,
                    const loop::Loop& loop) {
  for (const auto& [robot, heard] : heard_before) {
    for (std::size_t kind = 0; kind < heard.kinds.size(); ++kind) {
      const auto [accepted, forwarded] = heard.kinds[kind];
      if (std::isnan(accepted)) continue;
      counts.restore({static_cast<TrafficKind>(kind), robot}, time_of(loop, accepted),
                     time_of(loop, forwarded));
    }
  }
}

}  // namespace

Flow::Flow(loop::Loop& loop, ledger::Ledger& ledger, const settings::Settings& settings, Tokens tokens,
           const Folders& folders, Callbacks callbacks)
    : loop_(loop),
      ledger_(ledger),
      upkeep_(loop, ledger),
      settings_(settings),
      tokens_(std::move(tokens)),
      callbacks_(std::move(callbacks)),
      random_(seed()),
      spool_(folders.runtime + kWaiting, bytes_without_maps(settings)),
      writer_(loop),
      workers_(loop, 0),
      journal_(loop, folders.runtime + kJournal),
      clocks_(loop, journal_, folders.state),
      rejected_(loop, writer_, folders.runtime + kRejected),
      counts_([this] { on_changed(); }),
      servers_(loop),
      scoring_(loop, servers_, ledger, settings, tokens_.scoring, counts_, random_, journal_, clocks_),
      run_news_(settings),
      picture_(loop, workers_, [this] { on_changed(); }),
      maps_(loop, servers_, workers_, writer_, spool_, settings, tokens_.mapping, counts_, rejected_, random_,
            journal_, [this](icd::MapUpdate map) { picture_.on_forwarded(std::move(map)); }),
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
  std::vector<dispatch::Run> runs = ledger_.runs();
  restore_handover(newest_in(runs));
  scoring_.start(std::move(runs));
  telemetry_.start();
  has_started_ = true;
  update_picture();
}

void Flow::set_standby(const std::string& why) {
  standby_ = why;
  scoring_.set_standby();
  maps_.set_standby();
  telemetry_.set_standby();
}

/// Rates and stamps go on without a gap.
void Flow::restore_handover(double newest) {
  journal::HandoverState carried = journal_.read();
  const bool is_first = !carried.clock();
  clocks_.restore(carried, host::boot(), newest);
  scoring_.restore(carried);
  maps_.restore(carried, clocks_.has_run_before());
  telemetry_.restore(carried);
  restore(is_first);
  heard_before_ = carried.heard_by_robot();
  restore_counts(counts_, heard_before_, loop_);
}

/// Messages in files. Without a journal the last sending is unknown: maps get new stamps, all requests wait.
void Flow::restore(bool is_first) {
  rejected_.restore();
  spool::Spool::KeptMaps kept = spool_.read();
  if (is_first && !kept.empty()) {
    scoring_.assume_just_sent();
    maps_.assume_just_sent();
    telemetry_.assume_just_sent();
  }
  for (spool::Spool::KeptMap& each : kept) {
    if (is_first) each.map.header().stamp = loop_.stamp_now();
  }
  maps_.restore(std::move(kept));
}

void Flow::on_settings_changed(const settings::Restarts& restarts, Tokens tokens) {
  tokens_ = std::move(tokens);
  archive_.limit(limits_of(settings_));
  spool_.set_reserved(bytes_without_maps(settings_));
  if (restarts.scoring)
    scoring_.on_endpoint_changed(tokens_.scoring);  // first: no more requests to the old endpoint
  if (restarts.mapping) maps_.on_endpoint_changed(tokens_.mapping);
  if (restarts.mapping) telemetry_.on_endpoint_changed(tokens_.mapping);
  scoring_.on_settings_changed();
  maps_.on_settings_changed();
  telemetry_.on_settings_changed();
}

void Flow::on_link_up() {
  scoring_.on_link_up();
  maps_.on_link_up();
  telemetry_.on_link_up();
}

void Flow::tick(loop::Writer& disk) {
  meter_.on_second(sent_bytes());
  scoring_.tick();
  clocks_.keep(disk, ledger_.known_facts());
  if (!is_ending()) upkeep_.tick(disk);
  archive_.tick(archive_view());
}

KnownTimes Flow::known_times() const {
  return {.command_post = scoring_.channel().last().command_post_time(), .robots = clocks_.robots_time()};
}

/// Stamps, the ledger and earlier runs keep their times.
void Flow::on_wall_set(double seconds) {
  clocks_.on_wall_set();
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
    return archive_.write_now(archive_view());
  }
  drained_.call_at(loop_.now() + Ending::kStep);
  const bool scoring = scoring_.stop(), maps = maps_.stop(), telemetry = telemetry_.stop();
  const bool kept = maps_.has_stored_all() && rejected_.has_stored_all();
  if (!ending_.dismisses(loop_.now(), scoring && maps && telemetry, kept)) return;
  drained_.call_at(loop_.now() + Ending::kFlush);
  scoring_.dismiss();
}

namespace {

archive::Sample sample_of(const Flow& flow, double now) {
  std::map<std::string, double> ages;
  for (const facts::ActivityRow& row : flow.activities()) {
    const bool is_quiet = !row.age && row.heard.value_or(0) > alarms::kQuietAfter;
    if (!row.is_map() || is_quiet) continue;
    double& age = ages[row.robot];
    age = std::max(age, row.age.value_or(0));
  }
  const Channel& mapping =
      flow.maps().channel().last().answer_time() > flow.telemetry().channel().last().answer_time()
          ? flow.maps().channel()
          : flow.telemetry().channel();
  return {.at = now,
          .sent_mbit = flow.sent_mbit(),
          .queued_bytes = flow.maps().queued_bytes(),
          .scoring_ms = flow.scoring().channel().last().answer_ms(),
          .mapping_ms = mapping.last().answer_ms(),
          .throttled = flow.scoring().channel().last().throttled_answers() +
                       flow.maps().channel().last().throttled_answers() +
                       flow.telemetry().channel().last().throttled_answers(),
          .map_ages = {ages.begin(), ages.end()}};
}

api::RunRow facts_of(const Flow& flow, const std::string& course) {
  const dispatch::Run& run = flow.reports().run();
  std::set<std::string> robots;
  for (const facts::RobotRow& robot : flow.delivered_scene().robots()) robots.insert(robot.name);
  for (const auto& [traffic, row] : flow.counts().rows()) robots.insert(traffic.robot);
  robots.erase("");
  api::RunRow facts{.run = run.number,
                    .id = run.id,
                    .course = course,
                    .post = run.post,
                    .began = run.began,
                    .robots = {robots.begin(), robots.end()}};
  if (run.last) {
    facts.score = run.last->score;
    facts.remaining_reports = run.last->remaining_reports;
    facts.team = run.last->current_team;
  }
  return facts;
}

}  // namespace

/// Restores the present run, then records it.
void Flow::restore_run() {
  const dispatch::Run& run = reports().run();
  picture_.hold();
  archive_.begin({.run = run.number, .began = run.began, .post = run.post},
                 [this](picture::Mosaic picture, std::vector<api::Track> tracks) -> const picture::Mosaic& {
                   delivered_.restore(std::move(tracks));
                   picture_.restore(std::move(picture));
                   return picture_.mosaic();
                 });
}

archive::RunSnapshot Flow::archive_view() const {
  return {.now = loop_.wall_now(),
          .stamp = loop_.stamp_now(),
          .picture = picture_.mosaic(),
          .tracks = [this](api::Time since) { return delivered_.tracks().tracks_after(since); },
          .sample = [this] { return sample_of(*this, loop_.wall_now()); },
          .facts = [this] { return facts_of(*this, settings_.command_post.course); }};
}

}  // namespace adit::forward
