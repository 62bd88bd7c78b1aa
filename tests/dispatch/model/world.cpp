#include "dispatch/model/world.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "codec/read.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch::model {
namespace {

constexpr Seconds kShortestRun = 60;
constexpr Seconds kTrouble = 600, kCalm = 240;
constexpr std::size_t kClients = 12;
/// How late the Command Post may record what it has read before the connection was dropped: within the
/// rules' patience.
constexpr Seconds kLatest = 9;
constexpr Seconds kFlushSoon = 0.005;
constexpr Seconds kRoundTrip = 0.02;
/// Rules answer a client within 20 s, looked at each second.
constexpr Seconds kAnswered = 21.5;
/// Single writes that fail, where the disk fills up at times.
constexpr double kRefusedWrite = 0.02;

}  // namespace

World::World(const Trouble& trouble, std::uint64_t seed)
    : trouble_(trouble), random_(seed), posts_there_(trouble.courses ? 2 : 1, CommandPost(trouble.clocks)) {
  tells_ = std::getenv("ADIT_MODEL_STORY") != nullptr;
  disk_.cut = [this] {
    if (!calm_ && reports_ && chance() < trouble_.power_cut) throw PowerCut{};
  };
  start();
  for (std::size_t i = 0; i < kClients; ++i) {
    clients_.push_back({.key = static_cast<double>(i) + 100,
                        .patience = chance() < 0.5 ? 0.3 : between(1, 30),
                        .pause = between(0.01, 3),
                        .posted = {}});
    later(between(0, kTrouble * 0.8), [this, i] { post(i); }, false);
  }
  later(between(1, 30), [this] { make_trouble(); }, false);
  if (trouble_.courses) later(between(5, 60), [this] { switch_course(); }, false);
  later(20, [this] { take_operators_word(); }, false);
}

World::~World() = default;

// Time.

Time World::time() const {
  return {Reports::Instant(std::chrono::nanoseconds(static_cast<std::int64_t>(now_ * 1e9))), kEpoch + now_};
}

void World::later(Seconds delay, std::function<void()> happen, bool of_process) {
  events_.push({now_ + delay, ++order_, of_process ? life_ : 0, std::move(happen)});
}

void World::run_until(Seconds end) {
  while (!events_.empty() && events_.top().at <= end) {
    Event event = events_.top();
    events_.pop();
    now_ = event.at;
    if (event.life != 0 && (event.life != life_ || !reports_)) continue;
    ++tally_.steps;
    try {
      event.happen();
      if (reports_) pump();
      if (!calm_ && reports_ && chance() < trouble_.power_cut / 10) throw PowerCut{};
    } catch (const PowerCut&) {
      cut_power();
    }
  }
  now_ = end;
}

void World::live() {
  run_until(kTrouble);
  calm_ = true;
  disk_.full = false;
  tell_story("calm");
  run_until(kTrouble + kCalm);
  for (const Client& client : clients_) tally_.acknowledged += client.acknowledged ? 1 : 0;
  tally_.recorded = static_cast<std::int64_t>(recorded().size());
  for (const auto& [number, report] : disk_.content().reports) {
    tally_.undecided += report.state == ReportState::InDoubt ? 1 : 0;
    tally_.held += report.state == ReportState::Received ? 1 : 0;
  }
}

void World::tell_story(const std::string& sentence) {
  if (tells_) story_ += icd::sentence(now_, " ", sentence, "\n");
}

// Deeds.

bool World::write(std::span<const Report> steps, const Run* run, Flush flush) {
  if (!calm_ && trouble_.disk_full > 0 && chance() < kRefusedWrite) return false;
  if (!disk_.write(steps, run, flush == Flush::Now)) return false;
  if (flush == Flush::Soon) later(kFlushSoon, [this] { disk_.flush(); });
  if (run != nullptr && run->last && !first_heard_) first_heard_ = now_;
  if (run != nullptr) tell_story(icd::sentence("run ", run->number, " ", run->why));
  for (const Report& report : steps) {
    tell_story(icd::sentence("report ", report.number, " of ", report.report.position.x, " ",
                             name_of(report.state), " in run ", report.run, ": ", report.note));
    tally_.settled += report.reconciled ? 1 : 0;
    tally_.sent_again +=
        report.state == ReportState::Waiting && report.note.starts_with("not recorded") ? 1 : 0;
  }
  return true;
}

void World::tell(ClientId client, const ClientAnswer& answer, const Report& report) {
  if (answer.number != 0 && !disk_.content().reports.contains(answer.number)) {
    broken_.push_back(icd::sentence("report ", answer.number, " was called kept, and was not"));
  }
  const int status = answer.sentence.empty() ? report.status : static_cast<int>(answer.status);
  const auto found = posts_.find(client);
  if (found == posts_.end()) return;  // it has hung up
  const std::size_t who = found->second;
  posts_.erase(found);
  clients_[who].waiting = 0;
  const bool good = status >= 200 && status < 300;
  tell_story(icd::sentence("client ", clients_[who].key, " is told ", status, " ", answer.sentence));
  heard(who, good || (status < 500 && status != 429), good);
}

// Clients.

void World::post(std::size_t who) {
  Client& client = clients_[who];
  if (client.done || client.waiting != 0) return;
  if (client.tries_left-- <= 0) return;
  client.posted.push_back({now_, place_, reports_ && reports_->run().was_heard()});
  ++tally_.posts;
  if (!reports_) return heard(who, false, false);
  const ClientId id = ++last_post_;
  client.waiting = id;
  posts_[id] = who;
  later(
      client.patience,
      [this, who, id] {
        if (clients_[who].waiting != id) return;
        if (clients_[who].patience > kAnswered) {
          broken_.push_back(icd::sentence("client ", clients_[who].key, " was left without a word"));
        }
        posts_.erase(id);
        clients_[who].waiting = 0;
        heard(who, false, false);
      },
      false);
  const bool may_send = !busy_ && now_ >= report_ready_ && chance() < 0.5;
  Posted posted;
  posted.report.type = "Drill";
  posted.report.position.x = client.key;
  posted.sender = "robot";
  if (reports_->take(posted, id, may_send, time())) {
    transmit(*reports_->sending());
  }
}

void World::heard(std::size_t who, bool done, bool acknowledged) {
  Client& client = clients_[who];
  client.done = client.done || done;
  client.acknowledged = client.acknowledged || acknowledged;
  if (!client.done) later(client.pause, [this, who] { post(who); }, false);
}

// The box.

void World::start() {
  ++life_;
  busy_ = false;
  poll_at_ = now_;
  ReportRules rules;
  rules.review = trouble_.review;
  reports_ = std::make_unique<Reports>(rules, *this);
  const auto alive = [this](auto&& again) -> void {
    later(1, [this, again] {
      reports_->tick(time());
      again(again);
    });
  };
  alive(alive);
  tell_story("start");
  reports_->open(disk_.reports(), disk_.runs(), time(), icd::sentence("post ", place_, ":8000"));
}

/// The program begins anew, in good order, with another place in its settings. Whoever reported before does
/// so again, whatever he was told: a robot that was started anew, or an operator who is not sure.
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
  if (chance() < 0.5) disk_.lose_unflushed();  // else only the program has died
  reports_.reset();
  ++life_;
  for (const auto& pending : pending_) {
    if (!pending->done && pending->at > now_ + kLatest) {
      pending->at = now_ + between(0, kLatest);
      record_at(pending);
    }
  }
  for (const auto& [id, who] : std::exchange(posts_, {})) {
    clients_[who].waiting = 0;
    heard(who, false, false);
  }
  const auto restart = [this](auto&& again) -> void {
    try {
      start();
    } catch (const PowerCut&) {
      ++tally_.power_cuts;
      reports_.reset();
      ++life_;
      later(1, [again] { again(again); }, false);
    }
  };
  later(chance() < 0.8 ? between(0.1, 5) : between(5, 90), [restart] { restart(restart); }, false);
}

void World::pump() {
  if (busy_) return;
  const Wish wish = reports_->wish(time());
  if (wish.report && now_ >= report_ready_) {
    if (const Report* const report = reports_->choose(time())) transmit(*report);
    return;
  }
  const bool wanted = (wish.status && *wish.status <= time().now) || now_ >= poll_at_;
  if (wanted && now_ >= status_ready_) ask();
}

void World::record_at(const std::shared_ptr<Pending>& pending) {
  later(
      pending->at - now_,
      [this, pending] {
        if (pending->done || pending->at > now_ + 1e-9) return;
        pending->done = true;
        tell_story(icd::sentence("recorded ", pending->report.position.x));
        HttpAnswer answer = pending->post->record(pending->report, now_);
        if (pending->then) pending->then(std::move(answer));
      },
      false);
}

void World::record_later(Seconds delay, const icd::ArtifactReport& report,
                         std::function<void(HttpAnswer)> then) {
  auto pending = std::make_shared<Pending>(Pending{report, &post(), now_ + delay, std::move(then)});
  pending_.push_back(pending);
  record_at(pending);
}

void World::transmit(const Report& report) {
  busy_ = true;
  report_ready_ = now_ + 1;
  const auto answer = [this](Seconds delay, HttpAnswer said) {
    later(delay, [this, said = std::move(said)] {
      busy_ = false;
      tell_story(icd::sentence("answered ", said.status));
      reports_->answered(said, time());
    });
  };
  const auto lose = [this](Seconds delay) {
    later(delay, [this] {
      busy_ = false;
      tell_story("lost");
      reports_->lost("no answer", time());
    });
  };
  if (!is_anybody_there()) {
    later(between(0, 3), [this] {
      busy_ = false;
      reports_->never_left("nobody is there", time());
    });
    return;
  }
  double dice = calm_ ? 1 : chance();
  const auto falls = [&dice](double probability) { return (dice -= probability) < 0; };
  const Seconds lost_after = chance() < 0.5 ? kRoundTrip : between(0.1, 10);
  if (falls(trouble_.answer_lost)) {
    record_later(kRoundTrip / 2, report.report, nullptr);
    lose(lost_after);
  } else if (falls(trouble_.request_lost)) {
    lose(lost_after);
  } else if (falls(trouble_.late)) {
    record_later(lost_after + between(0, kLatest), report.report, nullptr);
    lose(lost_after);
  } else if (falls(trouble_.never_left)) {
    later(between(0, 3), [this] {
      busy_ = false;
      reports_->never_left("no way", time());
    });
  } else if (falls(trouble_.throttled)) {
    answer(kRoundTrip, {429, "application/json", "\"too many\""});
  } else if (falls(trouble_.barred)) {
    answer(kRoundTrip, {401, "application/json", "\"no token\""});
  } else if (falls(trouble_.refused)) {
    answer(kRoundTrip, {422, "application/json", "\"no\""});
  } else if (falls(trouble_.server_error)) {
    if (chance() < 0.5) record_later(kRoundTrip / 2, report.report, nullptr);
    answer(kRoundTrip, {500, "text/html", "<html>"});
  } else {
    const std::int64_t life = life_;
    record_later(kRoundTrip / 2, report.report, [answer, this, life](HttpAnswer said) {
      if (life == life_) answer(kRoundTrip / 2, std::move(said));
    });
  }
}

void World::ask() {
  busy_ = true;
  status_ready_ = now_ + 1;
  poll_at_ = now_ + 10;
  const bool fails = !calm_ && chance() < trouble_.status_fails;
  if (fails || !is_anybody_there()) {
    later(between(0, 3), [this, reached = chance() < 0.5 && is_anybody_there()] {
      busy_ = false;
      reports_->status_failed(reached, time());
    });
    return;
  }
  later(kRoundTrip / 2, [this] {
    later(kRoundTrip / 2, [this, status = post().status(now_)] {
      busy_ = false;
      tell_story(icd::sentence("status: ", status.remaining_reports, " left, score ", status.score));
      reports_->status_heard(status, time());
    });
  });
}

void World::take_operators_word() {
  later(20, [this] { take_operators_word(); }, false);
  if (!trouble_.operator_acts || !reports_) return;
  std::vector<Report> stuck;
  for (const auto& [number, report] : reports_->book().all()) {
    const bool waits = report.state == ReportState::Received || report.state == ReportState::InDoubt;
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
           : report.state == ReportState::InDoubt ? reports_->call_done(report.number, time())
                                                  : reports_->withdraw(report.number, time()));
  }
}

void World::declare_run() {
  if (reports_->run().began >= kEpoch + post().run_began()) return;
  declared_ = true;
  reports_->declare_new_run(time());
}

// Trouble that comes by itself.

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
