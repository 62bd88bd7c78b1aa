#include "forward/stamp_floor.hpp"

#include <charconv>
#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::forward {
namespace {

/// Year 2200: what is later is no stamp.
constexpr double kLatest = 7.26e9;

}  // namespace

double StampFloor::read() const {
  if (!host::may_exist(file_)) return 0;
  const auto text = host::read_file(file_);
  double floor = -1;
  if (text) std::from_chars(text->data(), text->data() + text->size(), floor);
  if (floor >= 0 && floor < kLatest) return floor;
  host::log(host::Level::Warning, "which stamps were given out before is not known",
            {{"why", text ? file_ + ": expected seconds since 1970" : text.error()}});
  return 0;
}

std::optional<double> StampFloor::due(double now) {
  if (now < next_) return {};
  next_ = now + kEvery;
  return now + kAhead;
}

void StampFloor::write(double floor) {
  const auto written = host::write_file(file_, std::to_string(floor) + '\n', host::kOursAlone);
  const std::string why = written ? "" : written.error();
  if (std::exchange(*trouble_, why) == why || written) return;
  host::log(host::Level::Warning, "after a power cut, stamps may run backward", {{"why", written.error()}});
}

}  // namespace adit::forward
