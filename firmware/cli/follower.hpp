#pragma once

#include <chrono>
#include <expected>
#include <memory>
#include <optional>
#include <string>

#include "api/run_view.hpp"
#include "cli/ask.hpp"
#include "cli/event_reader.hpp"
#include "cli/http_client.hpp"
#include "codec/value.hpp"

namespace adit::cli {

/// The run as a running Adit tells it, or why it does not.
struct Seen {
  codec::Value told;
  api::RunView view;
};
using Look = std::expected<Seen, std::string>;

/// Follows the events of a running Adit: the view whole, and then what changes. Where they end (a restart, a
/// cable) it asks for them again; where there are none to be had (as many pages are open as there may be), it
/// asks for the view alone, each second.
class Follower {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kAgain{1};
  /// Adit says something at least each 2 s; a slow line may hold it up.
  static constexpr std::chrono::seconds kSilence{6};

  explicit Follower(const Adit& adit) : adit_(adit) {}

  /// What is new, if anything is. To be called at first, when something has come at fd(), and at due().
  std::optional<Look> look();
  int fd() const { return stream_ ? stream_->fd() : -1; }
  Clock::time_point due() const { return stream_ ? heard_ + kSilence : again_; }

 private:
  std::optional<Look> open();
  std::optional<Look> ended(const HttpStream::Ended& end);
  std::optional<Look> lost(const std::string& why);
  Look ask() const;
  std::optional<Look> news();
  bool take(const Event& event);

  const Adit& adit_;
  std::unique_ptr<HttpStream> stream_;  // null: there is none, until again_
  EventReader events_;
  codec::Value told_;
  bool has_told_ = false;  // since it was opened
  Clock::time_point heard_{}, again_{};
};

}  // namespace adit::cli
