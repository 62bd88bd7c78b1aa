// Accepting and showing. flow_life.cpp has start and end.
#include "forward/flow.hpp"

#include <cmath>
#include <utility>

#include "host/log.hpp"
#include "icd/refuse.hpp"
#include "icd/try.hpp"
#include "intake/icd_routes.hpp"

namespace adit::forward {

std::shared_ptr<intake::MapArrival> Flow::map_arrives() {
  return maps_.arrives([this](icd::MapUpdate update, const intake::Sender& sender,
                              std::shared_ptr<spool::MapFile> file,
                              std::function<void(icd::Checked<void>)> done) {
    if (!standby_.empty()) return done(icd::refuse(icd::Status::ServiceUnavailable, standby_));
    take(std::move(update), sender, std::move(file), std::move(done));
  });
}

void Flow::take(icd::MapUpdate update, const intake::Sender& sender, std::shared_ptr<spool::MapFile> file,
                std::function<void(icd::Checked<void>)> done) {
  if (update.name) told_.posted(update.name->text());
  clocks_.stamp(update, sender);
  maps_.take(std::move(update), sender.bytes, std::move(file), std::move(done));
}

icd::Checked<void> Flow::take(icd::StateUpdate update, const intake::Sender& sender) {
  if (!standby_.empty()) return icd::refuse(icd::Status::ServiceUnavailable, standby_);
  for (const icd::NamedPose& pose : update.poses) told_.posted(pose.name.text());
  ADIT_TRY(telemetry_.has_room_for(update));
  return telemetry_.take(clocks_.stamped(update, sender), sender.bytes);
}

void Flow::take(icd::MarkersUpdate update, const intake::Sender& sender, MarkerArrivals::Done done) {
  if (!standby_.empty()) return done(icd::refuse(icd::Status::ServiceUnavailable, standby_));
  clocks_.stamp(update, sender);
  telemetry_.take(std::move(update), sender.bytes, std::move(done));
}

void Flow::take(const icd::ArtifactReport& report, const intake::Sender& sender,
                std::shared_ptr<intake::Responder> responder) {
  if (!standby_.empty())
    return responder->answer(intake::error_answer(icd::Status::ServiceUnavailable, standby_));
  scoring_.take(report, sender, std::move(responder));
}

void Flow::status(const intake::Sender&, std::shared_ptr<intake::Responder> responder) {
  if (!standby_.empty())
    return responder->answer(intake::error_answer(icd::Status::ServiceUnavailable, standby_));
  scoring_.status(std::move(responder));
}

/// A sentence may quote a client's token from a wrong field.
std::string Flow::without_tokens(std::string sentence) const {
  for (const icd::BearerToken& token : tokens_.all) token.strike_from(sentence);
  return sentence;
}

void Flow::left_out(icd::Uri uri, const intake::Sender& sender, const std::string& why) {
  host::log(
      host::Level::Info, "parts of a message rejected",
      {{"uri", std::string(icd::path_of(uri))}, {"sender", sender.address}, {"why", without_tokens(why)}});
}

/// gateway::Crowding logs wrong tokens together.
void Flow::refused(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& told) {
  icd::Refusal refusal = told;
  refusal.sentence = without_tokens(told.sentence);
  if (refusal.status != icd::Status::Unauthorized) {
    host::log(host::Level::Info, "message rejected",
              {{"uri", std::string(icd::path_of(uri))},
               {"sender", sender.address},
               {"status", std::to_string(static_cast<int>(refusal.status))},
               {"why", refusal.sentence}});
  }
  record_.refused(uri, sender, refusal, loop_.wall_now());
}

std::expected<void, std::string> Flow::rejected(std::uint64_t number, api::RejectedAction action) {
  if (is_ending()) return std::unexpected("aditd is stopping and sends no more messages");
  if (!standby_.empty()) return std::unexpected(standby_);
  if (action == api::RejectedAction::Discard) return rejected_.discard(number);
  auto message = ADIT_TRY(rejected_.to_be_sent(number));
  if (auto* const map = std::get_if<icd::MapUpdate>(&message)) {
    maps_.send_again(std::move(*map),
                     [this, number](bool kept) { return rejected_.sent_again(number, kept); });
  } else {
    rejected_.sent_again(number, telemetry_.send_again(message));
  }
  return {};
}

void Flow::changed() {
  picture_the_run();
  told_.changed();
}

/// Runs may have begun before this process or before a change of the Command Post.
dispatch::NextMap Flow::next_map(std::int64_t before, const dispatch::Run& run) const {
  const dispatch::Run* const known = reports().runs().find(before);
  const bool is_here = known != nullptr && reports().runs().is_here(before) && is_by_settings(run);
  return is_here ? dispatch::next_map(*known, run) : dispatch::NextMap::MayBeTheSame;
}

/// At the Command Post in the settings.
bool Flow::is_by_settings(const dispatch::Run& run) const {
  return run.post == address_text(settings_.command_post.scoring);
}

/// True if the clock of the status has changed.
bool Flow::status_came() {
  const auto& clock = reports().run().status_clock;
  const double shows = clock ? clock->shows : 0;
  return std::exchange(clock_shown_, shows) != shows;
}

void Flow::picture_the_run() {
  if (!has_started_) return;
  const dispatch::Run& run = reports().run();
  const std::int64_t before = std::exchange(pictured_run_, run.number);
  const bool is_heard = status_came();
  if (before == run.number) {
    if (is_heard && is_by_settings(run) && dispatch::tells_of_another(run)) maps_.heard();
    return;
  }
  if (before == 0) return keep_the_run();
  archive_.end_run(seen());
  maps_.change_run(next_map(before, run));
  telemetry_.change_run();
  delivered_.begin_run(loop_.wall_now());
  picture_.begin_run();
  keep_the_run();
}

/// Rounded, because each view reads two clocks.
std::optional<api::Time> Flow::behind_since(const Traffic& traffic) const {
  const auto since = is_map(traffic.kind) ? maps_.waits_since(traffic) : telemetry_.waits_since(traffic);
  if (!since) return std::nullopt;
  const api::Time at = loop_.wall_now() - std::chrono::duration<double>(loop_.now() - *since).count();
  return std::round(at * 1000) / 1000;
}

std::vector<api::ActivityRow> Flow::activities() const {
  std::vector<api::ActivityRow> rows;
  for (const auto& [traffic, counted] : record_.rows()) {
    api::ActivityRow& row = rows.emplace_back(counted);
    row.queued = is_map(traffic.kind) ? maps_.waiting(traffic) : telemetry_.waiting(traffic.kind);
    row.behind_since = behind_since(traffic);
  }
  return rows;
}

std::uint64_t Flow::sent_bytes() const {
  return scoring_.channel().bytes_sent() + maps_.channel().bytes_sent() + telemetry_.channel().bytes_sent();
}

}  // namespace adit::forward
