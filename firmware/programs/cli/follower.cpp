#include "cli/follower.hpp"

#include <utility>

#include "codec/json.hpp"
#include "codec/patch.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

Event event_of(std::string_view lines) {
  Event event;
  while (!lines.empty()) {
    const std::string_view line = icd::cut(lines, '\n');
    constexpr std::string_view kType = "event: ", kData = "data: ";
    if (line.starts_with(kType)) event.type = line.substr(kType.size());
    if (line.starts_with(kData)) event.data = line.substr(kData.size());
  }
  return event;
}

FetchResult parse_view(const Adit& adit, const codec::Value& told) {
  FetchedRun seen{told, {}};
  const auto is_read = read_into(adit, told, codec::kind_of<api::RunView>, &seen.view);
  if (!is_read) return std::unexpected(is_read.error().sentence);
  return seen;
}

}  // namespace

std::optional<Event> EventReader::next() {
  while (true) {
    const std::size_t end = unread_.find("\n\n", searched_);
    if (end == std::string::npos) {
      searched_ = unread_.empty() ? 0 : unread_.size() - 1;
      return std::nullopt;
    }
    Event event = event_of(std::string_view(unread_).substr(0, end));
    unread_.erase(0, end + 2);
    searched_ = 0;
    if (!event.data.empty()) return event;
  }
}

std::optional<FetchResult> Follower::poll() {
  if (!stream_) return Clock::now() < again_ ? std::nullopt : open();
  auto came = stream_->read();
  if (!came) return on_ended(came.error());
  if (!came->empty()) {
    heard_ = Clock::now();
  } else if (Clock::now() >= heard_ + kSilence) {
    return on_lost("no event for 6 s");
  }
  events_.feed(*came);
  return read_events();
}

std::optional<FetchResult> Follower::open() {
  again_ = Clock::now() + kAgain;
  auto stream =
      ADIT_TRY(HttpStream::ask(adit_.address, adit_.token.token, get_request("/adit/events"), kReadPatience));
  stream_ = std::move(stream);
  events_ = {};
  has_told_ = false;
  heard_ = Clock::now();
  return std::nullopt;
}

/// After a stream that had events, asks again at once. Only if that fails is Adit away.
std::optional<FetchResult> Follower::on_ended(const HttpStream::StreamEnd& end) {
  if (end.status != 0) {
    stream_.reset();
    return ask();
  }
  if (!has_told_) return on_lost(end.why);
  stream_.reset();
  return Clock::now() < again_ ? std::nullopt : open();
}

std::optional<FetchResult> Follower::on_lost(const std::string& why) {
  stream_.reset();
  return std::unexpected("lost the connection to Adit at " + to_text(adit_.address) + ": " + why);
}

FetchResult Follower::ask() const {
  const auto json = get(adit_, "/adit/run");
  if (!json) return std::unexpected(json.error().sentence);
  const auto told = json_in(adit_, *json);
  if (!told) return std::unexpected(told.error().sentence);
  return parse_view(adit_, *told);
}

std::optional<FetchResult> Follower::read_events() {
  bool is_news = false;
  while (const auto event = events_.next()) {
    if (!on_event(*event)) return on_lost("cannot read an event");
    is_news = true;
  }
  if (events_.waiting() > kLargestBody) return on_lost("an event is too long");
  if (!is_news) return std::nullopt;
  has_told_ = true;
  return parse_view(adit_, told_);
}

bool Follower::on_event(const Event& event) {
  auto data = codec::parse_json(event.data);
  if (!data) return false;
  if (event.type != "patch") {
    told_ = *std::move(data);
    return true;
  }
  auto now = codec::apply_patch(std::move(told_), *data);
  if (!now) return false;
  told_ = *std::move(now);
  return true;
}

}  // namespace adit::cli
