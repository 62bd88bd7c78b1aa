#include "api/self_test.hpp"

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
    member<&TestedEndpoint::name>("name").one_of(kEndpoints),
    member<&TestedEndpoint::address>("address"),
    member<&TestedEndpoint::steps>("steps"),
};

constexpr Member kTest[] = {
    member<&TestView::running>("running"),
    member<&TestView::endpoints>("endpoints"),
};

}  // namespace

constexpr codec::Row TestStep::kRow = {"", kTestStep};
constexpr codec::Row TestedEndpoint::kRow = {"", kTestedEndpoint};
constexpr codec::Row TestView::kRow = {"Test", kTest};

}  // namespace adit::api
