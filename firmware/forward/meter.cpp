#include "forward/meter.hpp"

namespace adit::forward {

void Meter::second(std::uint64_t bytes) {
  bytes_.push_back(bytes);
  if (bytes_.size() > kSeconds + 1) bytes_.pop_front();
}

double Meter::mbit() const {
  if (bytes_.size() < 2) return 0;
  const auto bytes = static_cast<double>(bytes_.back() - bytes_.front());
  return bytes * 8 / 1e6 / static_cast<double>(bytes_.size() - 1);
}

}  // namespace adit::forward
