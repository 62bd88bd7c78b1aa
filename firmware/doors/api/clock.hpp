#pragma once

#include <optional>
#include <string>

#include "clock/messages.hpp"
#include "codec/row.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// The time of day and its source.
struct ClockView {
  double now = 0;                                      // seconds since 1970
  bool managed = false;                                // whether it can be set here
  std::string why;                                     // why not, or ""
  std::optional<clock::Source> source = std::nullopt;  // std::nullopt: not managed
  bool is_set = false;
  std::string refusal;   // why the last change failed
  std::string ntp = "";  // state of NTP, or why it does not work; "": not in the settings
  bool is_kept = false;  // an NTP server keeps the time, so it cannot be set
  static const codec::Row kRow;
};

/// Sets the time of day. A refusal says why not.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual ClockView state() const = 0;
  /// Requests the operator's time; takes effect soon.
  virtual icd::Checked<void> set_clock(double time) = 0;
};

}  // namespace adit::api
