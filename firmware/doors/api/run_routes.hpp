#pragma once

#include <cstdint>
#include <string>

#include "api/answers.hpp"
#include "api/entrance.hpp"
#include "api/live.hpp"
#include "api/source.hpp"

namespace adit::api {

/// The state of the run, and the operator's actions except those on reports.
class RunRoutes {
 public:
  static constexpr double kLeast = 1, kMost = 60;  // seconds of flashing lights

  /// All must outlive this object.
  RunRoutes(const Source& source, Operator& decisions, Caretaker& caretaker, Live& live, Entrance& entrance)
      : source_(source), operator_(decisions), caretaker_(caretaker), live_(live), entrance_(entrance) {}

  intake::Answer run() const;
  std::unique_ptr<intake::BodySink> events(const Call& call);
  intake::Answer begin_run();
  /// Replaces a ledger that cannot be read.
  intake::Answer begin_ledger();
  /// An action on a rejected message.
  template <RejectedAction action>
  intake::Answer rejected(std::uint64_t number) {
    return rejected(number, action);
  }
  /// Acknowledges an alarm.
  intake::Answer acknowledge(const std::string& body);
  /// Flashes the box's lights for some seconds, to identify the box.
  intake::Answer identify(const std::string& body);

 private:
  intake::Answer rejected(std::uint64_t number, RejectedAction action);

  const Source& source_;
  Operator& operator_;
  Caretaker& caretaker_;
  Live& live_;
  Entrance& entrance_;
};

}  // namespace adit::api
