#include "host/memory.hpp"

#include <algorithm>

namespace adit::host {
namespace {

std::string clipped(std::string_view text) {
  return std::string(text.substr(0, Memory::kLongest));
}

std::size_t bytes_of(const Record& record) {
  std::size_t bytes = sizeof record + record.message.size();
  for (const auto& [name, value] : record.fields) bytes += 2 * sizeof name + name.size() + value.size();
  return bytes;
}

}  // namespace

void Memory::keep(double at, Level level, std::string_view message, std::span<const Field> fields) {
  Record record{.seq = 0, .at = at, .level = level, .message = clipped(message), .fields = {}};
  record.fields.reserve(fields.size());
  for (const auto& [name, value] : fields) {
    if (!value.empty()) record.fields.emplace_back(name, clipped(value));
  }
  const std::scoped_lock lock(mutex_);
  record.seq = ++last_;
  bytes_ += bytes_of(record);
  records_.push_back(std::move(record));
  while (records_.size() > kMost || bytes_ > kMostBytes) drop_the_oldest();
}

void Memory::drop_the_oldest() {
  bytes_ -= bytes_of(records_.front());
  records_.pop_front();
}

std::uint64_t Memory::last() const {
  const std::scoped_lock lock(mutex_);
  return last_;
}

std::vector<Record> Memory::after(std::uint64_t seq) const {
  const std::scoped_lock lock(mutex_);
  const auto first = std::ranges::upper_bound(records_, seq, {}, &Record::seq);
  return {first, records_.end()};
}

}  // namespace adit::host
