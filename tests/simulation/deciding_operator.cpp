#include "simulation/deciding_operator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/courses.hpp"
#include "simulation/http.hpp"
#include "simulation/intended_runs.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr double kSure = 20;   // seconds after which the Command Post does not record a lost request any more
constexpr double kAfter = 90;  // seconds that the operator stays once the trouble is over
constexpr const char* kHeaders =
    "Host: 10.0.0.1\r\nAuthorization: Bearer token-of-the-team\r\nContent-Type: application/json\r\n";

std::string number(std::int64_t value) {
  return std::to_string(value);
}

std::string drill(std::int64_t serial) {
  return nlohmann::json{{"type", "Drill"}, {"x", static_cast<double>(serial) * 100}, {"y", 2.5}, {"z", -1.0}}
      .dump();
}

}  // namespace

DecidingOperator::DecidingOperator(World& world, double trouble_for)
    : world_(world),
      random_(world.random("judge")),
      client_(world, "10.0.0.12", {.keeps_alive = false, .patience = 20, .dribbles = 0.1},
              world.random("client of the judge")),
      trouble_for_(trouble_for),
      looks_(random_.chance(0.4)),
      composes_(looks_ && random_.chance(0.3)) {
  world_.after(seconds(looks_ ? random_.uniform(1, 8) : trouble_for), [this] { look(); });
}

bool DecidingOperator::is_over() const {
  return world_.time() > trouble_for_;
}

void DecidingOperator::look() {
  if (world_.time() > trouble_for_ + kAfter) return;
  world_.after(seconds(is_over() ? 10 : random_.uniform(2, 12)), [this] { look(); });
  if (is_over()) client_.is_needed();
  if (client_.busy() || !decisions_.empty()) return;
  if (!is_over() && composes_ && random_.chance(0.3)) compose();
  client_.ask(http_request("GET", "/adit/run", kHeaders, ""), {.what = "/adit/run", .who = "reader"},
              [this](int status) {
                if (status == 200) read_view(nlohmann::json::parse(client_.heard()));
                post_next();
              });
}

void DecidingOperator::read_view(const nlohmann::json& view) {
  place_ = place_at(view.at("endpoints").front().at("address"));
  if (looks_) {
    for (const nlohmann::json& row : view.at("reports")) {
      // A report in doubt at another course is decided there.
      const bool elsewhere = row.at("run") != view.at("run_number") && row.at("state") == "in_doubt";
      if (!elsewhere) decide(row);
    }
    if (random_.chance(0.05)) decisions_.push_back({"/adit/identify", "identify", R"({"seconds": 4})", 0});
  }
  for (const nlohmann::json& row : view.at("rejected")) decide_rejected(row);
}

void DecidingOperator::decide(const nlohmann::json& row) {
  const std::string state = row.at("state");
  if (row.at("position").is_null()) {  // lost from a damaged ledger
    // Before, a client may post it again.
    if (is_over() && state == "in_doubt") push_decision(row.at("number"), kSettle, 0);
    return;
  }
  const std::int64_t id = row.at("number"),
                     serial = std::llround(row.at("position").at("x").get<double>() / 100);
  if (!is_over() && random_.chance(0.4)) return;
  if (state == "in_doubt" && !row.at("asking") && world_.time() > left_at(serial) + kSure)
    push_decision(id, is_recorded(serial) ? kSettle : kSend, serial);
  if (state == "held") decide_held(id, serial);
  if (state == "queued" && !is_over() && random_.chance(0.2)) push_decision(id, kHold, serial);
}

/// The operator sends a held report if the current run has no record of it.
void DecidingOperator::decide_held(std::int64_t id, std::int64_t serial) {
  if (serial < kCorrections && !is_recorded(serial) && random_.chance(0.2)) return correct(id, serial);
  const bool sends = !is_recorded(serial) && random_.chance(0.6);
  push_decision(id, sends ? kSend : kWithdraw, serial);
}

void DecidingOperator::decide_rejected(const nlohmann::json& row) {
  const bool replaced = row.at("replaced");
  if (!is_over() && !looks_) return;
  if (replaced && random_.chance(0.5)) return;
  const std::string path = "/adit/rejected/" + number(row.at("number"));
  decisions_.push_back(
      {path + (replaced ? "/discard" : "/send"), replaced ? "discard" : kSendRejected, "", 0});
}

void DecidingOperator::compose() {
  const std::int64_t serial = kOwnReports + ++composed_;
  decisions_.push_back({"/adit/reports", kCompose, drill(serial), serial});
}

void DecidingOperator::correct(std::int64_t id, std::int64_t serial) {
  const std::int64_t next = serial + kCorrections;
  decisions_.push_back({"/adit/reports/" + number(id) + "/correct", kCorrect, drill(next), next});
}

/// He decides about one of several equal reports at a time, and then looks again.
void DecidingOperator::push_decision(std::int64_t id, const char* what, std::int64_t serial) {
  if (std::ranges::any_of(decisions_, [&](const Decision& each) { return each.serial == serial; })) return;
  decisions_.push_back({"/adit/reports/" + number(id) + "/" + what, what, "", serial});
}

void DecidingOperator::post_next() {
  if (decisions_.empty()) return;
  const Decision decision = std::move(decisions_.front());
  decisions_.pop_front();
  client_.ask(http_request("POST", decision.path, kHeaders, decision.body),
              {.what = decision.what, .who = kOperator, .serial = decision.serial},
              [this](int) { post_next(); });
}

bool DecidingOperator::is_recorded(std::int64_t serial) const {
  const auto& events = world_.history().events();
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    const bool is_record = event->kind == Kind::Taken && event->what == kReports && event->serial == serial;
    const bool begins = event->kind == Kind::NewRun && event->what != kSameMap;
    if ((!is_record && !begins) || place_of(event->who) != place_) continue;
    return is_record;
  }
  return false;
}

double DecidingOperator::left_at(std::int64_t serial) const {
  const auto& events = world_.history().events();
  const auto left = std::find_if(events.rbegin(), events.rend(), [&](const Event& event) {
    return event.kind == Kind::Left && event.what == kReports && event.serial == serial;
  });
  return left == events.rend() ? 0 : left->at;
}

}  // namespace adit::simulation
