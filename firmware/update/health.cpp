#include "update/health.hpp"

#include <charconv>
#include <cstdint>

#include "icd/sentence.hpp"

namespace adit::update {

std::string_view value_of(std::string_view name, std::string_view lines) {
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    const std::string_view line = lines.substr(0, end);
    if (line.starts_with(name) && line.substr(name.size()).starts_with('='))
      return line.substr(name.size() + 1);
    if (end == std::string_view::npos) break;
    lines.remove_prefix(end + 1);
  }
  return "";
}

Ready read_ready(std::string_view properties, std::chrono::microseconds now) {
  if (value_of("ActiveState", properties) != "active") return std::nullopt;
  const std::string_view since = value_of("ActiveEnterTimestampMonotonic", properties);
  std::int64_t microseconds = 0;
  const auto [end, error] = std::from_chars(since.data(), since.data() + since.size(), microseconds);
  if (error != std::errc{} || end != since.data() + since.size() || microseconds <= 0) return std::nullopt;
  const std::chrono::microseconds at(microseconds);
  return at <= now ? Ready(now - at) : std::nullopt;
}

std::string wait_for_trial(std::string_view version) {
  return icd::sentence(version, " is on trial: wait until it has been healthy for ", kHealthyFor.count(),
                       " s");
}

Health judge(bool trial, const Ready& ready, bool late) {
  if (ready && (!trial || *ready >= kHealthyFor)) return Health::Good;
  return trial && late ? Health::Restart : Health::Wait;
}

}  // namespace adit::update
