#include "cli/event_reader.hpp"

#include "icd/text.hpp"

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

}  // namespace adit::cli
