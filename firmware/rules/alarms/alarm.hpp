#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "codec/row.hpp"

namespace adit::alarms {

/// "45 s", "12 min", "2:05 h", as the page's age(). `seconds` may be negative.
std::string age_text(double seconds);
/// Minutes and seconds: "1:34", "61:15".
std::string clock_text(double seconds);
/// "scoring" -> "Scoring"
std::string capital(std::string text);

/// One line: "The scoring token is missing: reports stay queued until a token is set".
template <class Said>
std::string line_of(const Said& said) {
  return said.why.empty() ? said.what : said.what + ": " + said.why;
}

/// Urgency of a condition, the worst first. A normal state is not a condition.
enum class Severity : std::uint8_t {
  Bad,   // something does not work
  Ask,   // needs a decision of the operator
  Wait,  // may pass by itself
};
inline constexpr std::string_view kSeverityWords[] = {"bad", "ask", "wait"};
constexpr auto& words_of(Severity /*of*/) {
  return kSeverityWords;
}

/// Location of the cause.
enum class Side : std::uint8_t { Robot, Box, Network, CommandPost };
inline constexpr std::string_view kSideWords[] = {"robot", "box", "network", "command_post"};
constexpr auto& words_of(Side /*of*/) {
  return kSideWords;
}

/// The one thing to do.
struct Action {
  std::string word = {};  // on the button: "Show robot"
  std::string link = {};  // path on the box's pages: "/#robot=uav5"
  static const codec::Row kRow;
  friend bool operator==(const Action&, const Action&) = default;
};

/// The main part of a reason: all of it, or up to the last of its marks (": ", "; ", ", ", " (") in 60 bytes.
std::string reason_of(const std::string& why);

/// "uav5 is silent", and afterwards "uav5 was silent".
struct Headline {
  std::string subject = {};  // "uav5"
  std::string state = {};    // "silent"
  bool plural = false;       // of the subject: "are", "were"

  std::string now() const { return subject + (plural ? " are " : " is ") + state; }
  std::string past() const { return subject + (plural ? " were " : " was ") + state; }
  friend bool operator==(const Headline&, const Headline&) = default;
};

/// A fault or a question, as the rules find it.
struct Condition {
  std::string id = {};  // unchanged while the condition lasts: "robot_silent:uav5"
  Severity severity = Severity::Bad;
  Side side = Side::Box;
  std::string subject = {};  // part of the id after the colon: a robot, an endpoint, a report's number
  double since = 0;          // seconds since 1970; 0: since first found
  Headline headline = {};    // at most six words
  std::string why = {};      // clause in lower case without a full stop, what matters first; or ""
  Action action = {};
  std::uint64_t degree = 0;  // grows with the fault; an acknowledgement covers this degree and lower ones
  std::uint64_t hides = 0;   // number of unlisted conditions that follow from this one
  friend bool operator==(const Condition&, const Condition&) = default;
};

/// A condition as all faces show it.
struct Alarm {
  std::string id = {};
  Severity severity = Severity::Bad;
  Side side = Side::Box;
  std::string subject = {};
  double since = 0;  // seconds since 1970
  std::string what = {}, why = {};
  std::string details = {};  // the whole reason if `why` is only its beginning
  Action action = {};
  bool acknowledged = false;
  std::uint64_t hides = 0;

  static const codec::Row kRow;
  friend bool operator==(const Alarm&, const Alarm&) = default;
};

struct EndedAlarm {
  std::string id = {};
  Severity severity = Severity::Bad;
  Side side = Side::Box;
  std::string was = {};         // "uav5 was silent"
  double since = 0, until = 0;  // seconds since 1970

  static const codec::Row kRow;
  friend bool operator==(const EndedAlarm&, const EndedAlarm&) = default;
};

}  // namespace adit::alarms
