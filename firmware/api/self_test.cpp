#include "api/self_test.hpp"

namespace adit::api {
namespace {

using codec::member;
using codec::Member;

constexpr std::string_view kEndpoints[] = {"scoring", "mapping"};
constexpr std::string_view kSteps[] = {"link", "address", "cables", "reach", "token", "clock"};
constexpr std::string_view kStates[] = {"waiting", "running", "good", "bad", "skipped"};

constexpr Member kStep[] = {
    member<&TestStep::name>("name").one_of(kSteps),
    member<&TestStep::state>("state").one_of(kStates),
    member<&TestStep::said>("said"),
    member<&TestStep::advice>("advice"),
};

constexpr Member kEndpoint[] = {
    member<&TestedEndpoint::name>("name").one_of(kEndpoints),
    member<&TestedEndpoint::address>("address"),
    member<&TestedEndpoint::steps>("steps"),
};

constexpr Member kTest[] = {
    member<&TestView::running>("running"),
    member<&TestView::endpoints>("endpoints"),
};

}  // namespace

constinit const codec::Row TestStep::kRow = {"", kStep};
constinit const codec::Row TestedEndpoint::kRow = {"", kEndpoint};
constinit const codec::Row TestView::kRow = {"Test", kTest};

}  // namespace adit::api
