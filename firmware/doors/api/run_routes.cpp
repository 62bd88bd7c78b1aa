#include "api/run_routes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "api/route.hpp"
#include "codec/patch.hpp"
#include "codec/row.hpp"
#include "icd/try.hpp"
#include "intake/answer.hpp"

namespace adit::api {
namespace {

constexpr auto kSpacing = std::chrono::milliseconds{1000 / RunStream::kEventsPerSecond};
constexpr std::chrono::seconds kCalm{1};

/// Rounds to ms, mm or microseconds, which is finer than the page shows and halves the text.
double round_number(double number) {
  constexpr double kSteps = 1000;
  return std::round(number * kSteps) / kSteps + 0.0;  // avoids -0
}

/// How long after the last event a patch may be sent. Clocks change all the time and are not news. An
/// operator acts on reports and alarms.
std::chrono::milliseconds spacing_of(const std::optional<codec::Value>& patch) {
  std::chrono::milliseconds spacing = RunStream::kHeartbeat;
  if (!patch) return spacing;
  for (const auto& [name, value] : std::get<codec::Value::Object>(patch->is)) {
    if (name == "reports" || name == "alarms") return kSpacing;
    if (name != "now" && name != "run_clock") spacing = kCalm;
  }
  return spacing;
}

}  // namespace

RunStream::RunStream(loop::Loop& loop, Source& source)
    : loop_(loop), source_(source), timer_(loop.timer([this] { send_to_all(false); })) {}

RunView RunStream::take_view() {
  RunView view = source_.view();
  codec::change_numbers(RunView::kRow, &view, round_number);
  // Ages change all the time. Whole seconds keep events small.
  const auto whole_seconds = [](std::optional<double>& age) {
    if (age) *age = std::floor(*age);
  };
  for (facts::EndpointRow& row : view.endpoints) whole_seconds(row.answered);
  for (facts::ActivityRow& row : view.activities) whole_seconds(row.age), whole_seconds(row.heard);
  for (facts::RobotRow& robot : view.robots) whole_seconds(robot.age);
  for (facts::StandingRow& robot : view.standings) whole_seconds(robot.age), whole_seconds(robot.heard);
  return view;
}

const std::string& RunStream::full_state() {
  if (whole_.empty()) whole_ = "data: " + codec::to_json(told_) + "\n\n";
  whole_size_ = whole_.size();
  return whole_;
}

void RunStream::open(intake::Responder& responder, std::function<bool()> has_access) {
  if (pages_.size() >= kMostPages) drop_closed(":\n\n");
  if (pages_.size() >= kMostPages) {
    return responder.answer(intake::error_answer(
        icd::Status::ServiceUnavailable,
        "too many pages are open: the box serves at most " + std::to_string(kMostPages) + " at once"));
  }
  if (pages_.empty()) {
    begin();
  } else if (loop_.now() >= looked_ + kSpacing) {
    send_to_all(true);  // so that the whole view is no older than kSpacing
  }
  auto stream = responder.stream("text/event-stream");
  if (!stream || !stream->send("retry: 1000\n" + full_state())) return;
  pages_.push_back({std::move(stream), std::move(has_access)});
}

void RunStream::begin() {
  told_ = take_view();
  whole_.clear();
  looked_ = sent_ = loop_.now();
  dirty_ = false;
  timer_.call_at(sent_ + kHeartbeat);
}

void RunStream::on_changed() {
  if (pages_.empty() || std::exchange(dirty_, true)) return;
  timer_.call_at(std::max(loop_.now(), looked_ + kSpacing));
}

void RunStream::send_to_all(bool in_any_case) {
  dirty_ = false;
  looked_ = loop_.now();
  RunView now = take_view();
  const codec::Value nothing{codec::Value::Object()};
  const auto patch = codec::patch(told_, now);
  const auto spacing = spacing_of(patch);
  if (in_any_case || looked_ >= sent_ + spacing) {
    told_ = std::move(now);
    whole_.clear();
    sent_ = looked_;
    drop_closed("event: patch\ndata: " + codec::write_json(patch.value_or(nothing)) + "\n\n");
    if (!pages_.empty()) timer_.call_at(sent_ + kHeartbeat);
  } else {
    timer_.call_at(sent_ + spacing);
  }
}

bool RunStream::send_event(const OpenPage& page, std::string_view event) {
  if (!page.has_access()) return false;
  const bool is_slow = page.stream->waiting() + event.size() > 2 * whole_size_ + kMostPatches;
  return is_slow ? page.stream->send_instead(full_state()) : page.stream->send(event);
}

void RunStream::drop_closed(std::string_view event) {
  std::erase_if(pages_, [&](const OpenPage& page) { return !send_event(page, event); });
}

using codec::json;

std::unique_ptr<intake::BodySink> RunRoutes::events(const Call& call) {
  live_.open(*call.responder, authenticator_.access_check(call.asker));
  return nullptr;
}

intake::Answer RunRoutes::begin_run() {
  return object({{"run", json(operator_.begin_run())}});
}

intake::Answer RunRoutes::begin_ledger() {
  const auto kept_as = gateway_control_.begin_ledger();
  return kept_as ? object({{"kept_as", json(*kept_as)}}) : refusal_answer(kept_as.error());
}

intake::Answer RunRoutes::change_rejected(std::uint64_t number, RejectedAction action) {
  const auto done = operator_.change_rejected(number, action);
  return done ? object({{"rejected", json(number)}}) : refusal(icd::Status::Conflict, done.error());
}

icd::Checked<intake::Answer> RunRoutes::acknowledge(const std::string& body) {
  const auto id = ADIT_TRY(read_text(body, "id"));
  const auto done = gateway_control_.acknowledge(id);
  return done ? object({{"acknowledged", json(id)}}) : refusal(icd::Status::Conflict, done.error());
}

icd::Checked<intake::Answer> RunRoutes::identify(const std::string& body) {
  const auto seconds = ADIT_TRY(read_body<double>(
      body, [](const codec::Field& root) { return root.member("seconds").number(kLeast, kMost); }));
  return object({{"identify_until", json(gateway_control_.identify(seconds))}});
}

}  // namespace adit::api
