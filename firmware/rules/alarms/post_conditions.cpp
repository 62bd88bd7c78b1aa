// Conditions of the Command Post and its two endpoints.
#include <algorithm>
#include <string>
#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/conditions.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using facts::EndpointFault;
using facts::EndpointRow;
using icd::sentence;

const Action kOpenAddresses{"Open set-up", "/setup#post"};
const Action kOpenTokens{"Open set-up", "/setup#tokens-post"};
const Action kTest{"Open test", "/setup#test"};

/// The same trouble of one endpoint or of both.
struct Trouble {
  EndpointFault is = EndpointFault::None;
  double since = 0;
  std::vector<const EndpointRow*> endpoints = {};
  std::string only_robot = {};  // sole_robot()

  bool is_at_both() const { return endpoints.size() > 1; }
  const EndpointRow& first() const { return *endpoints.front(); }
  /// "Command Post" or "Mapping"
  std::string subject() const { return is_at_both() ? "Command Post" : capital(first().name); }
  /// "10.100.1.200:8000"
  std::string address_text() const {
    return is_at_both() ? endpoints[0]->address + " and " + endpoints[1]->address : first().address;
  }
};

Condition condition_of(const Trouble& trouble, std::string name) {
  return {.id = std::move(name),
          .severity = trouble.is == EndpointFault::Throttling ? Severity::Wait : Severity::Bad,
          .side = Side::CommandPost,
          .subject = trouble.is_at_both() ? "" : trouble.first().name,
          .since = trouble.since,
          .action = kTest,
          .degree = trouble.endpoints.size()};
}

void find_missing_tokens(const facts::Traffic& traffic, Conditions& found) {
  for (const EndpointRow& endpoint : traffic.endpoints) {
    if (endpoint.fault != EndpointFault::NoToken) continue;
    const bool scoring = endpoint.name == "scoring";
    found.push_back({.id = "no_token:" + endpoint.name,
                     .side = Side::Box,
                     .subject = endpoint.name,
                     .since = endpoint.since,
                     .headline = {"The " + endpoint.name + " token", "missing"},
                     .why = sentence(scoring ? "reports" : "maps, states and markers", " stay queued"),
                     .action = kOpenTokens});
  }
}

void describe_unreachable(const Trouble& trouble, Condition& condition) {
  condition.headline = {trouble.subject(), "unreachable"};
  condition.why = trouble.first().said + "; the box tries again";
}

void describe_foreign(const Trouble& trouble, Condition& condition) {
  condition.headline = {"The server", "not a Command Post"};
  condition.why =
      sentence(trouble.address_text(), trouble.is_at_both() ? "" : " (" + trouble.first().name + ")",
               "; check the address");
  condition.action = kOpenAddresses;
}

void describe_refusing(const Trouble& trouble, Condition& condition) {
  condition.headline = trouble.is_at_both() ? Headline{"Both tokens", "rejected", true}
                                            : Headline{"The " + trouble.first().name + " token", "rejected"};
  condition.why = "the Command Post answers 401 or 403; is the course right?";
  if (!trouble.is_at_both() && trouble.first().name == "mapping" && !trouble.only_robot.empty())
    condition.why = sentence("the Command Post answers 401 or 403; is the course right, and does it know ",
                             trouble.only_robot, "?");
  condition.action = kOpenTokens;
}

void describe_silent(const Trouble& trouble, Condition& condition) {
  condition.headline = {trouble.subject(), "silent"};
  condition.why = sentence("no answer from ", trouble.address_text());
}

void describe_failing(const Trouble& trouble, Condition& condition) {
  condition.headline = {trouble.subject(), "failing"};
  condition.why = sentence("its answer to every request: ", trouble.first().said);
}

void describe_throttling(const Trouble& trouble, Condition& condition) {
  condition.headline = {trouble.subject(), "throttling"};
  condition.why = "it answers 429; Adit sends less often";
  condition.action = {};
}

constexpr struct {
  EndpointFault is;
  const char* id;
  void (*say)(const Trouble&, Condition&);
} kTroubles[] = {
    {EndpointFault::Unreachable, "command_post_unreachable", describe_unreachable},
    {EndpointFault::Foreign, "command_post_foreign", describe_foreign},
    {EndpointFault::Refusing, "command_post_refusing", describe_refusing},
    {EndpointFault::Silent, "command_post_silent", describe_silent},
    {EndpointFault::Failing, "command_post_failing", describe_failing},
    {EndpointFault::Throttling, "command_post_throttling", describe_throttling},
};

/// "": none or several have sent data.
std::string sole_robot(const facts::Traffic& traffic) {
  std::string only;
  for (const facts::ActivityRow& row : traffic.activities) {
    if (row.robot.empty() || row.robot == only) continue;
    if (!only.empty()) return "";
    only = row.robot;
  }
  return only;
}

}  // namespace

void find_command_post_troubles(const facts::Traffic& traffic, Conditions& found) {
  find_missing_tokens(traffic, found);
  const std::string only_robot = sole_robot(traffic);
  for (const auto& row : kTroubles) {
    Trouble trouble{.is = row.is, .only_robot = only_robot};
    for (const EndpointRow& endpoint : traffic.endpoints) {
      if (endpoint.fault != row.is) continue;
      trouble.since = trouble.endpoints.empty() ? endpoint.since : std::min(trouble.since, endpoint.since);
      trouble.endpoints.push_back(&endpoint);
    }
    if (trouble.endpoints.empty()) continue;
    Condition condition = condition_of(trouble, row.id);
    row.say(trouble, condition);
    found.push_back(std::move(condition));
  }
}

}  // namespace adit::alarms
