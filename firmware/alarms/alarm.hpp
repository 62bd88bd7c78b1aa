#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "codec/row.hpp"

namespace adit::alarms {

/// How urgent a condition is, the worst first. What is normal is no condition.
enum class Severity : std::uint8_t {
  Bad,   // something does not work
  Ask,   // it waits for the operator's word
  Wait,  // it may pass by itself, and should be known
};
inline constexpr std::string_view kSeverityWords[] = {"bad", "ask", "wait"};

/// Where the cause is, and so who can mend it.
enum class Side : std::uint8_t { Robot, Box, Network, CommandPost };
inline constexpr std::string_view kSideWords[] = {"robot", "box", "network", "command_post"};

/// The one thing to do about it.
struct Action {
  std::string word = {};  // on a button: "Show robot"
  std::string link = {};  // where on the box's pages: "/#robot=uav5"
  static const codec::Row kRow;
  friend bool operator==(const Action&, const Action&) = default;
};

/// "uav5 is silent", and once that is over: "uav5 was silent".
struct Headline {
  std::string subject = {};  // "uav5"
  std::string state = {};    // "silent"
  bool plural = false;       // of the subject: "are", "were"

  std::string now() const { return subject + (plural ? " are " : " is ") + state; }
  std::string past() const { return subject + (plural ? " were " : " was ") + state; }
  friend bool operator==(const Headline&, const Headline&) = default;
};

/// What is not as it should be, as the rules find it.
struct Condition {
  std::string id = {};  // stable while it lasts: "robot_silent:uav5"
  Severity severity = Severity::Bad;
  Side side = Side::Box;
  std::string subject = {};  // the part of the id behind the colon: a robot, an endpoint, a report's number
  double since = 0;          // seconds since 1970; 0: since it was first found
  Headline headline = {};    // at most six words
  std::string why = {};      // a short sentence, in lower case and without a full stop; may be ""
  Action action = {};
  std::uint64_t degree = 0;  // grows as it gets worse: an acknowledgement holds only up to that
  std::uint64_t hides = 0;   // how many others follow from it, and are not listed
  friend bool operator==(const Condition&, const Condition&) = default;
};

}  // namespace adit::alarms

namespace adit::codec {

template <>
struct KindOf<alarms::Severity> : KindOfWords<alarms::Severity, alarms::kSeverityWords> {};
template <>
struct KindOf<alarms::Side> : KindOfWords<alarms::Side, alarms::kSideWords> {};

}  // namespace adit::codec

namespace adit::alarms {

/// A condition as everybody shows it.
struct Alarm {
  std::string id = {};
  Severity severity = Severity::Bad;
  Side side = Side::Box;
  std::string subject = {};
  double since = 0;  // seconds since 1970
  std::string what = {}, why = {};
  Action action = {};
  bool acknowledged = false;
  std::uint64_t hides = 0;

  static const codec::Row kRow;
  friend bool operator==(const Alarm&, const Alarm&) = default;
};

/// One that went.
struct Over {
  std::string id = {};
  Severity severity = Severity::Bad;
  Side side = Side::Box;
  std::string was = {};         // "uav5 was silent"
  double since = 0, until = 0;  // seconds since 1970

  static const codec::Row kRow;
  friend bool operator==(const Over&, const Over&) = default;
};

}  // namespace adit::alarms
