#pragma once

#include <optional>
#include <string>

#include "clock/source.hpp"
#include "codec/row.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// The time of day, and who set it.
struct ClockView {
  double now = 0;        // seconds since 1970
  bool managed = false;  // it can be set here
  std::string why;       // why not; "" where it can
  clock::Source source = clock::Source::None;
  bool is_set = false;
  std::string refusal;   // why the last change came to nothing
  std::string ntp = "";  // what is done about NTP, or why it is not; "" where the settings do not ask for it
  bool is_kept = false;  // an NTP server keeps it: nobody else may set it
  static const codec::Row kRow;
};

/// What sets it. A refusal says why not.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual ClockView clock() const = 0;
  /// On the operator's word, soon.
  virtual icd::Checked<void> set_clock(double time) = 0;
};

}  // namespace adit::api
