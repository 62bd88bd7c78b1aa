// Faults from outside, and the operator.
#include <utility>

#include "dispatch/model/world.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch::model {
namespace {

constexpr Seconds kShortestRun = 60;

}  // namespace

/// An orderly restart with another Command Post in the settings. Clients that posted before may repeat their
/// reports, whatever their answers were.
void World::switch_course() {
  if (calm_) return;
  later(between(5, 90), [this] { switch_course(); }, false);
  if (!reports_ || busy_) return;
  place_ = static_cast<std::size_t>(between(0, static_cast<double>(posts_there_.size()) + 0.999));
  tell_story(icd::sentence("the settings name place ", place_));
  ++tally_.switches;
  disk_.flush();
  reports_->dismiss(true);
  reports_.reset();
  ++life_;
  start();
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    if (clients_[i].posted.empty() || chance() < 0.5) continue;
    clients_[i].done = false;
    clients_[i].tries_left += 3;
    later(between(0, 20), [this, i] { post(i); }, false);
  }
}

void World::cut_power() {
  tell_story("power cut");
  ++tally_.power_cuts;
  if (chance() < 0.5) disk_.lose_unflushed();  // otherwise only the process is killed
  reports_.reset();
  ++life_;
  drop_connections();
  for (const auto& [id, who] : std::exchange(posts_, {})) {
    clients_[who].waiting = 0;
    heard(who, false, false);
  }
  later(chance() < 0.8 ? between(0.1, 5) : between(5, 90), [this] { switch_on(); }, false);
}

void World::switch_on() {
  try {
    start();
  } catch (const PowerCut&) {
    ++tally_.power_cuts;
    reports_.reset();
    ++life_;
    later(1, [this] { switch_on(); }, false);
  }
}

void World::take_operators_word() {
  later(20, [this] { take_operators_word(); }, false);
  if (!trouble_.operator_acts || !reports_) return;
  std::vector<Report> stuck;
  for (const auto& [number, report] : reports_->book().all()) {
    const bool waits = report.state == ReportState::Held || report.state == ReportState::InDoubt;
    if (waits && !reports_->is_asking(report)) stuck.push_back(report);
  }
  const std::set<std::int64_t> waiting = reports_->book().waiting();
  for (const std::int64_t number : waiting) {
    if (chance() < 0.6) continue;
    tell_story(icd::sentence("the operator holds report ", number));
    tally_.held_back += reports_->hold(number, time()).has_value() ? 1 : 0;
  }
  for (const Report& report : stuck) {
    if (chance() < 0.6) continue;
    touched_.insert(report.report.position.x);
    const bool sends = chance() < 0.5;
    tell_story(icd::sentence("the operator judges report ", report.number));
    (void)(sends                                  ? reports_->send(report.number, time())
           : report.state == ReportState::InDoubt ? reports_->settle(report.number, time())
                                                  : reports_->withdraw(report.number, time()));
  }
}

void World::declare_run() {
  if (reports_->run().began >= kEpoch + post().run_began()) return;
  declared_ = true;
  reports_->declare_new_run(time());
}

void World::make_trouble() {
  if (calm_) return;
  later(between(5, 60), [this] { make_trouble(); }, false);
  if (trouble_.other_sender && chance() < 0.2) {
    tell_story("another sender reports");
    others_.push_back(now_);
    post().other_sender(now_);
  }
  if (trouble_.admin_stops) {
    post().set(chance() < 0.3 ? CommandPost::Phase::AdminStop : CommandPost::Phase::Running);
  }
  if (trouble_.new_runs && chance() < 0.15 && now_ > post().run_began() + kShortestRun) {
    tell_story("a new run");
    post().new_run(now_);
    if (trouble_.operator_acts) later(between(0, 3), [this] { declare_run(); });
  }
  if (chance() < trouble_.disk_full) {
    disk_.full = true;
    later(between(0.5, 30), [this] { disk_.full = false; }, false);
  }
}

}  // namespace adit::dispatch::model
