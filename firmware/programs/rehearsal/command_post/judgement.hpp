#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rehearsal/command_post/fields.hpp"
#include "rehearsal/command_post/http.hpp"
#include "rehearsal/command_post/json.hpp"
#include "rehearsal/command_post/messages.hpp"

namespace adit::rehearsal {

/// A part of a message that was taken, as it is counted.
struct Accepted {
  std::string kind;   // "grid", "cloud", "pose", "marker", "report"
  std::string robot;  // a map's or a pose's name, a marker's ns; "" where there is none
};

/// All that an endpoint has to say of one request: what is done about it and what is written down.
struct Judgement {
  Outcome outcome;
  std::string uri;  // one of the ICD's five; "": none of them
  Findings findings;
  std::optional<Json> message;        // as it came
  std::optional<MapMessage> map;      // where one was taken
  std::optional<OrderedJson> report;  // where one was recorded: what was answered
  std::vector<Accepted> accepted;
  std::vector<MarkerChange> markers;  // that were taken
  std::string fault;                  // the rehearsed fault; "": none
};

/// One of the Command Post's two endpoints, of one manner. Safe for use by several threads.
class Endpoint {
 public:
  Endpoint() = default;
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;
  virtual ~Endpoint() = default;

  virtual Judgement judge(const Request& request) = 0;
};

/// An answer whose body is this JSON.
template <class AnyJson>
Outcome answered(int status, const AnyJson& body) {
  Outcome outcome;
  outcome.answer.status = status;
  outcome.answer.body = line_of(body);
  return outcome;
}

}  // namespace adit::rehearsal
