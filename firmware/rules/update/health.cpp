#include "update/health.hpp"

#include <cstdint>

#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::update {

std::string_view value_of(std::string_view name, std::string_view lines) {
  while (!lines.empty()) {
    std::string_view line = icd::cut(lines, '\n');
    if (line.contains('=') && icd::cut(line, '=') == name) return line;
  }
  return "";
}

Ready read_ready(std::string_view properties, std::chrono::microseconds now) {
  if (value_of("ActiveState", properties) != "active") return std::nullopt;
  const auto since = icd::number_in<std::int64_t>(value_of("ActiveEnterTimestampMonotonic", properties));
  const std::chrono::microseconds at(since.value_or(0));
  return at.count() > 0 && at <= now ? Ready(now - at) : std::nullopt;
}

std::string wait_for_trial(std::string_view version) {
  return icd::sentence(version, " is on trial: wait until it has been healthy for ", kHealthyFor.count(),
                       " s");
}

Health classify(bool trial, const Ready& ready, bool late) {
  if (ready && (!trial || *ready >= kHealthyFor)) return Health::Good;
  return trial && late ? Health::Restart : Health::Wait;
}

}  // namespace adit::update
