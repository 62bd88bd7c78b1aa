#pragma once

#include <chrono>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "api/run_view.hpp"
#include "cli/ask.hpp"
#include "codec/value.hpp"

namespace adit::cli {

/// A server-sent event (HTML Living Standard 9.2) in Adit's form, with one line of data.
struct Event {
  std::string type;  // "": without an `event:` line
  std::string data;
};

/// Reads events from a stream in pieces.
class EventReader {
 public:
  void feed(std::string_view piece) { unread_ += piece; }
  /// The next complete event with data, or std::nullopt.
  std::optional<Event> next();
  /// Bytes of an incomplete event.
  std::size_t waiting() const { return unread_.size(); }

 private:
  std::string unread_;
  std::size_t searched_ = 0;  // searched bytes of unread_ without an event's end
};

/// The run as Adit reports it, or why it does not.
struct FetchedRun {
  codec::Value told;
  api::RunView view;
};
using FetchResult = std::expected<FetchedRun, std::string>;

/// Follows a running Adit by its events: the whole view, then its changes. After the stream ends (a restart,
/// a cable) it opens a new one. If too many pages are open, it fetches the view each second.
class Follower {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kAgain{1};
  /// Longest silence. Adit sends at least every 2 s, and a slow line may delay that.
  static constexpr std::chrono::seconds kSilence{6};

  explicit Follower(const Adit& adit) : adit_(adit) {}

  /// The news, if any. Call first, then if fd() is readable, and at due().
  std::optional<FetchResult> poll();
  int fd() const { return stream_ ? stream_->fd() : -1; }
  Clock::time_point due() const { return stream_ ? heard_ + kSilence : again_; }

 private:
  std::optional<FetchResult> open();
  std::optional<FetchResult> on_ended(const HttpStream::StreamEnd& end);
  std::optional<FetchResult> on_lost(const std::string& why);
  FetchResult ask() const;
  std::optional<FetchResult> read_events();
  bool on_event(const Event& event);

  const Adit& adit_;
  std::unique_ptr<HttpStream> stream_;  // null: no stream until again_
  EventReader events_;
  codec::Value told_;
  bool has_told_ = false;  // since it was opened
  Clock::time_point heard_{}, again_{};
};

}  // namespace adit::cli
