#include "forward/stamp_floor.hpp"

#include <charconv>
#include <filesystem>
#include <utility>
#include <vector>

#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::forward {
namespace {

/// Year 2200: what is later is no stamp.
constexpr double kLatest = 7.26e9;

/// What host::write_file() leaves beside a file where death comes in between: "stamps.a1B2c3".
void remove_unfinished(const std::filesystem::path& file) {
  constexpr std::size_t kRandom = 6;
  const std::string begins = file.filename().string() + '.';
  std::error_code error;
  std::vector<std::filesystem::path> unfinished;
  for (std::filesystem::directory_iterator entry(file.parent_path(), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(begins) && name.size() == begins.size() + kRandom) {
      unfinished.push_back(entry->path());
    }
  }
  for (const auto& each : unfinished) std::filesystem::remove(each, error);
}

}  // namespace

double StampFloor::read() const {
  remove_unfinished(file_);
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

void StampFloor::write(double floor) const {
  const auto written = host::write_file(file_, std::to_string(floor) + '\n', host::kOursAlone);
  const std::string why = written ? "" : written.error();
  if (std::exchange(*trouble_, why) == why || written) return;
  host::log(host::Level::Warning, "after a power cut, stamps may run backward", {{"why", written.error()}});
}

}  // namespace adit::forward
