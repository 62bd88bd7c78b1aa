#include "api/live.hpp"

#include <algorithm>
#include <utility>

#include "intake/icd_routes.hpp"

namespace adit::api {
namespace {

constexpr auto kSpacing = std::chrono::milliseconds{1000 / Live::kEventsPerSecond};

}  // namespace

Live::Live(loop::Loop& loop, const Source& source)
    : loop_(loop), source_(source), timer_(loop.timer([this] { send_to_all(); })) {}

std::string Live::event() const {
  return "data: " + codec::to_json(source_.view()) + "\n\n";
}

void Live::open(intake::Responder& responder, std::function<bool()> may_stay) {
  if (pages_.size() >= kMostPages) drop_the_gone(":\n\n");
  if (pages_.size() >= kMostPages) {
    return responder.answer(intake::error_answer(
        icd::Status::ServiceUnavailable,
        "as many pages are open as this box serves at once (" + std::to_string(kMostPages) + ")"));
  }
  auto stream = responder.stream("text/event-stream");
  if (!stream || !stream->send("retry: 1000\n" + event())) return;
  if (pages_.empty()) {
    sent_ = loop_.now();
    dirty_ = false;
    timer_.call_at(sent_ + kHeartbeat);
  }
  pages_.push_back({std::move(stream), std::move(may_stay)});
}

void Live::changed() {
  if (pages_.empty() || std::exchange(dirty_, true)) return;
  timer_.call_at(std::max(loop_.now(), sent_ + kSpacing));
}

void Live::send_to_all() {
  dirty_ = false;
  sent_ = loop_.now();
  drop_the_gone(event());
  if (!pages_.empty()) timer_.call_at(sent_ + kHeartbeat);
}

void Live::drop_the_gone(std::string_view bytes) {
  std::erase_if(pages_, [&](const OpenPage& page) { return !page.may_stay() || !page.stream->send(bytes); });
}

}  // namespace adit::api
