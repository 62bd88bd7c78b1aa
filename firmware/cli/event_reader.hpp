#pragma once

#include <optional>
#include <string>
#include <string_view>

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

}  // namespace adit::cli
