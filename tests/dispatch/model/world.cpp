#include "dispatch/model/world.hpp"

#include <cstdlib>
#include <utility>

#include "icd/sentence.hpp"

namespace adit::dispatch::model {
namespace {

constexpr Seconds kTrouble = 600, kCalm = 240;
constexpr std::size_t kClients = 12;
constexpr Seconds kFlushSoon = 0.005;
/// 20 s by the rules, which are applied each second.
constexpr Seconds kAnswered = 21.5;
/// Probability that a single write fails in worlds with a full disk.
constexpr double kRefusedWrite = 0.02;

}  // namespace

World::World(const Trouble& trouble, std::uint64_t seed)
    : trouble_(trouble),
      random_(seed),
      posts_there_(trouble.courses ? 2 : 1, CommandPost(trouble.clocks, trouble.one_name)) {
  tells_ = std::getenv("ADIT_MODEL_STORY") != nullptr;
  disk_.cut = [this] {
    if (!calm_ && reports_ && chance() < trouble_.power_cut) throw PowerCut{};
  };
  switch_on();
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
  return {Instant(std::chrono::nanoseconds(static_cast<std::int64_t>(now_ * 1e9))), kEpoch + now_};
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
    tally_.held += report.state == ReportState::Held ? 1 : 0;
  }
}

void World::tell_story(const std::string& sentence) {
  if (tells_) story_ += icd::sentence(now_, " ", sentence, "\n");
}

// Output.

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
        report.state == ReportState::Queued && report.note.starts_with("not recorded") ? 1 : 0;
  }
  return true;
}

void World::answer_client(ClientId client, const ClientAnswer& answer, const Report& report) {
  if (answer.number != 0 && !disk_.content().reports.contains(answer.number)) {
    broken_.push_back(icd::sentence("report ", answer.number, " was called kept, and was not"));
  }
  const int status = answer.sentence.empty() ? report.status : static_cast<int>(answer.status);
  const auto found = posts_.find(client);
  if (found == posts_.end()) return;  // disconnected
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
  PostedReport posted;
  posted.report.type = "Drill";
  posted.report.position.x = client.key;
  posted.sender = "robot";
  if (reports_->accept(posted, id, may_send, time())) {
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

}  // namespace adit::dispatch::model
