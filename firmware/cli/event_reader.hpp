#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace adit::cli {

/// A server-sent event (HTML Living Standard 9.2) as Adit writes one: its data is one line.
struct Event {
  std::string type;  // "": it has no `event:` line
  std::string data;
};

/// The events of a stream that comes in pieces.
class EventReader {
 public:
  void feed(std::string_view piece) { unread_ += piece; }
  /// The next whole one that has data.
  std::optional<Event> next();
  /// Bytes that have come of one that is not whole.
  std::size_t waiting() const { return unread_.size(); }

 private:
  std::string unread_;
  std::size_t searched_ = 0;  // of unread_, in which no event ends
};

}  // namespace adit::cli
