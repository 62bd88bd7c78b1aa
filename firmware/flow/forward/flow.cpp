// Accepting and showing. flow_life.cpp has start and end.
#include "forward/flow.hpp"

#include <cmath>
#include <utility>

#include "host/log.hpp"
#include "icd/refuse.hpp"
#include "icd/try.hpp"
#include "intake/icd_routes.hpp"

namespace adit::forward {
namespace {

queues::Upload upload_of(const intake::Sender& sender) {
  return {.address = sender.address,
          .bytes = sender.bytes,
          .began = sender.began,
          .ended = sender.ended,
          .overlaps = sender.overlaps};
}

}  // namespace

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
  const queues::Upload upload = upload_of(sender);
  clocks_.stamp(update, upload);
  maps_.take(std::move(update), upload, std::move(file), std::move(done));
}

icd::Checked<void> Flow::take(icd::StateUpdate update, const intake::Sender& sender) {
  if (!standby_.empty()) return icd::refuse(icd::Status::ServiceUnavailable, standby_);
  for (const icd::NamedPose& pose : update.poses) told_.posted(pose.name.text());
  ADIT_TRY(telemetry_.has_room_for(update));
  return telemetry_.take(clocks_.stamped(update, upload_of(sender)), sender.bytes);
}

void Flow::take(icd::MarkersUpdate update, const intake::Sender& sender, MarkerArrivals::Done done) {
  if (!standby_.empty()) return done(icd::refuse(icd::Status::ServiceUnavailable, standby_));
  queues::Upload upload = upload_of(sender);
  clocks_.stamp(update, upload);
  telemetry_.take(std::move(update), std::move(upload), std::move(done));
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

std::string Tokens::strike_from(std::string sentence) const {
  for (const icd::BearerToken& token : all) token.strike_from(sentence);
  return sentence;
}

void Flow::left_out(icd::Uri uri, const intake::Sender& sender, const std::string& why) {
  host::log(host::Level::Info, "parts of a message rejected",
            {{"uri", std::string(icd::path_of(uri))},
             {"sender", sender.address},
             {"why", tokens_.strike_from(why)}});
}

/// gateway::Crowding logs wrong tokens together.
void Flow::refused(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& told) {
  icd::Refusal refusal = told;
  refusal.sentence = tokens_.strike_from(told.sentence);
  if (refusal.status != icd::Status::Unauthorized) {
    host::log(host::Level::Info, "message rejected",
              {{"uri", std::string(icd::path_of(uri))},
               {"sender", sender.address},
               {"status", std::to_string(static_cast<int>(refusal.status))},
               {"why", refusal.sentence}});
  }
  counts_.refused(uri, sender, refusal, loop_.wall_now());
}

std::expected<void, std::string> Flow::rejected(std::uint64_t number, api::RejectedAction action) {
  if (is_ending()) return std::unexpected("aditd is stopping and sends no more messages");
  if (!standby_.empty()) return std::unexpected(standby_);
  if (action == api::RejectedAction::Discard) return rejected_.discard(number);
  auto item = ADIT_TRY(rejected_.to_be_sent(number));
  if (auto* const map = std::get_if<icd::MapUpdate>(&item.message)) {
    maps_.send_again(
        std::move(*map), [this, number](bool kept) { return rejected_.sent_again(number, kept); },
        item.bounds, item.faults);
  } else {
    rejected_.sent_again(number, telemetry_.send_again(item.message));
  }
  return {};
}

void Flow::changed() {
  picture_the_run();
  told_.changed();
}

void Flow::picture_the_run() {
  if (!has_started_) return;
  switch (run_news_.look(reports())) {
    case RunNews::Change::None:
      return;
    case RunNews::Change::LikelyAnother:
      maps_.heard();
      return;
    case RunNews::Change::FirstLook:
      break;
    case RunNews::Change::Another:
      archive_.end_run(seen());
      maps_.change_run(run_news_.next_map());
      telemetry_.change_run();
      delivered_.begin_run(loop_.wall_now());
      picture_.begin_run();
      break;
  }
  keep_the_run();
}

namespace {

/// Rounded, because each view reads two clocks.
api::Time wall_time_of(const loop::Loop& loop, loop::Instant since) {
  const api::Time at = loop.wall_now() - std::chrono::duration<double>(loop.now() - since).count();
  return std::round(at * 1000) / 1000;
}

}  // namespace

std::vector<api::ActivityRow> Flow::activities() const {
  std::vector<api::ActivityRow> rows;
  for (const auto& [traffic, counted] : counts_.rows()) {
    api::ActivityRow& row = rows.emplace_back(counted);
    row.queued = is_map(traffic.kind) ? maps_.waiting(traffic) : telemetry_.waiting(traffic.kind);
    const auto since = is_map(traffic.kind) ? maps_.waits_since(traffic) : telemetry_.waits_since(traffic);
    if (since) row.behind_since = wall_time_of(loop_, *since);
  }
  return rows;
}

std::uint64_t Flow::sent_bytes() const {
  return scoring_.channel().bytes_sent() + maps_.channel().bytes_sent() + telemetry_.channel().bytes_sent();
}

}  // namespace adit::forward
