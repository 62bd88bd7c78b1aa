#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "alarms/alarm.hpp"
#include "codec/row.hpp"

namespace adit::alarms {

/// That somebody has seen an alarm, as it was then: what outlives the end of the service.
struct Acknowledged {
  static constexpr std::size_t kMost = 64;       // that are kept
  static constexpr std::size_t kLongest = 1024;  // bytes of what and why: longer ones are not kept
  static constexpr double kHolds = 3600;         // seconds that one holds over an end of the service
  static constexpr double kWaitsFor = 60;        // seconds after a start within which its alarm is back

  std::string id = {};
  Severity severity = Severity::Wait;
  std::uint64_t degree = 0;
  std::string what = {}, why = {};
  double at = 0;  // seconds since 1970

  static const codec::Row kRow;
  friend bool operator==(const Acknowledged&, const Acknowledged&) = default;
};

/// As a file: {"version": 1, "acknowledged": [...]}.
std::string write_acknowledged(const std::vector<Acknowledged>& all);
/// What is no such file is refused as a whole.
std::expected<std::vector<Acknowledged>, std::string> read_acknowledged(std::string_view json);

}  // namespace adit::alarms
