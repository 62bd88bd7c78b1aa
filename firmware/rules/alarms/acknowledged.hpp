#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "alarms/alarm.hpp"
#include "codec/row.hpp"

namespace adit::alarms {

/// An acknowledgement of an alarm as it then was. It outlives a restart of the service.
struct Acknowledged {
  static constexpr std::size_t kMost = 64;       // stored acknowledgements
  static constexpr std::size_t kLongest = 1024;  // bytes of what and why; longer ones are not stored
  static constexpr double kHolds = 3600;         // seconds of validity across a restart
  static constexpr double kWaitsFor = 60;        // seconds after a start within which the alarm must return

  std::string id = {};
  Severity severity = Severity::Wait;
  std::uint64_t degree = 0;
  std::string what = {}, why = {};
  double at = 0;  // seconds since 1970

  static const codec::Row kRow;
  friend bool operator==(const Acknowledged&, const Acknowledged&) = default;
};

/// The file: {"version": 1, "acknowledged": [...]}.
std::string write_acknowledged(const std::vector<Acknowledged>& all);
/// An error anywhere rejects the whole file.
std::expected<std::vector<Acknowledged>, std::string> read_acknowledged(std::string_view json);

}  // namespace adit::alarms
