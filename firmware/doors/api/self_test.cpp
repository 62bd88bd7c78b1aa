#include "api/self_test.hpp"

#include <algorithm>

#include "api/route.hpp"
#include "api/run_view.hpp"

namespace adit::api {
namespace {

using codec::member;
using codec::Member;

constexpr std::string_view kSteps[] = {"link", "address", "cables", "reach", "token", "clock"};
constexpr std::string_view kStates[] = {"waiting", "running", "good", "bad", "skipped"};

constexpr Member kTestStep[] = {
    member<&TestStep::name>("name").one_of(kSteps),
    member<&TestStep::state>("state").one_of(kStates),
    member<&TestStep::said>("said"),
    member<&TestStep::advice>("advice"),
};

constexpr Member kTestedEndpoint[] = {
    member<&TestedEndpoint::name>("name").one_of(facts::kEndpoints),
    member<&TestedEndpoint::address>("address"),
    member<&TestedEndpoint::steps>("steps"),
};

constexpr Member kTest[] = {
    member<&TestView::number>("number", "counts the tests since aditd started; 0 before the first"),
    member<&TestView::running>("running"),
    member<&TestView::applied>("applied",
                               "whether the settings in use are tested; false for named endpoints"),
    member<&TestView::outdated>("outdated", "whether settings or tokens have changed since the test began"),
    member<&TestView::course>(
        "course", "course whose addresses and tokens are used if none were named; empty for no course"),
    member<&TestView::endpoints>("endpoints"),
};

/// Rejects other members, because a misspelt name would test the wrong values.
void know(const codec::Field& field, std::span<const std::string_view> names) {
  if (!field.is<codec::Value::Object>()) return field.refuse_kind("an object");
  for (const auto& [name, value] : std::get<codec::Value::Object>(field.value()->is)) {
    if (std::ranges::find(names, name) == names.end())
      field.refuse("no such member: ", icd::in_quotes(name), "; expected ", codec::in_turn(names));
  }
}

Candidate::Endpoint endpoint_in(const codec::Field& field) {
  constexpr std::string_view kKnown[] = {"address", "port", "token"};
  know(field, kKnown);
  Candidate::Endpoint endpoint;
  const codec::Field address = field.member("address"), port = field.member("port"),
                     token = field.member("token");
  if (!address.is_absent()) endpoint.address = address.text();
  if (!port.is_absent()) endpoint.port = port.whole<std::uint16_t>(1);
  if (token.is_absent() || token.is_empty_text()) return endpoint;
  endpoint.token = icd::BearerToken::parse(token.text());
  if (!endpoint.token) token.refuse("expected 1 to 256 visible ASCII characters");
  return endpoint;
}

Candidate candidate_in(const codec::Field& root) {
  constexpr std::string_view kKnown[] = {"course", "scoring", "mapping"};
  know(root, kKnown);
  Candidate candidate;
  const codec::Field course = root.member("course"), scoring = root.member("scoring"),
                     mapping = root.member("mapping");
  if (!course.is_absent()) candidate.course = course.text();
  if (!scoring.is_absent()) candidate.scoring = endpoint_in(scoring);
  if (!mapping.is_absent()) candidate.mapping = endpoint_in(mapping);
  return candidate;
}

}  // namespace

icd::Checked<Candidate> read_candidate(const std::string& body) {
  if (body.empty()) return Candidate{};
  return read_body<Candidate>(body, candidate_in);
}

constexpr codec::Row TestStep::kRow = {"", kTestStep};
constexpr codec::Row TestedEndpoint::kRow = {"", kTestedEndpoint};
constexpr codec::Row TestView::kRow = {"Test", kTest};

}  // namespace adit::api
