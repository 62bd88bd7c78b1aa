#include "archive/lines.hpp"

#include <utility>

namespace adit::archive {

void Lines::add(std::string record, bool is_news) {
  bytes_ += record.size();
  records_.push_back(std::move(record));
  is_due_ = is_due_ || is_news;
  keep_below(kMost);
}

std::string Lines::take(loop::Instant now) {
  std::string taken;
  while (!records_.empty() && taken.size() + records_.front().size() <= kLargestRecord) {
    taken += records_.front();
    records_.pop_front();
  }
  bytes_ -= taken.size();
  is_due_ = !records_.empty();
  rests_until_ = now + kRest;
  return taken;
}

void Lines::give_back(std::string records) {
  if (records.empty()) return;
  bytes_ += records.size();
  records_.push_front(std::move(records));
  is_due_ = true;
}

void Lines::keep_below(std::size_t most) {
  while (bytes_ > most) {
    bytes_ -= records_.front().size();
    records_.pop_front();
  }
}

}  // namespace adit::archive
