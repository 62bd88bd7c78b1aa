#include "api/box.hpp"

namespace adit::codec {

/// An object with a member for each field.
template <>
struct KindOf<api::LogFields> : WriteOnly {
  static Value write(const api::LogFields& fields) {
    Value::Object object;
    for (const auto& [name, value] : fields) object.emplace_back(name, Value{value});
    return {std::move(object)};
  }
  static constexpr Schema schema = {.type = "object", .more = R"("additionalProperties":{"type":"string"})"};
};

}  // namespace adit::codec

namespace adit::api {
namespace {

using codec::member;
using codec::Member;

constexpr std::string_view kLevels[] = {"error", "warning", "notice", "info", "debug"};

constexpr Member kRecord[] = {
    member<&LogRecord::seq>("seq", "number of the record since the start of aditd"),
    member<&LogRecord::at>("at", "seconds since 1970"),
    member<&LogRecord::level>("level").one_of(kLevels),
    member<&LogRecord::message>("message"),
    member<&LogRecord::fields>("fields"),
};

constexpr Member kPage[] = {
    member<&LogPage::last>("last",
                           "number of the last record; if it is less than since, aditd was restarted"),
    member<&LogPage::records>("records"),
};

constexpr Member kPart[] = {
    member<&PartRow::name>("name"),
    member<&PartRow::version>("version"),
    member<&PartRow::licence>("licence", "SPDX"),
};

constexpr Member kBoard[] = {
    member<&BoardRow::name>("name"),
    member<&BoardRow::title>("title"),
};

constexpr Member kAbout[] = {
    member<&About::version>("version"),
    member<&About::build>("build"),
    member<&About::licence>("licence", "SPDX"),
    member<&About::started>("started", "seconds since 1970"),
    member<&About::uptime>("uptime", "seconds"),
    member<&About::kernel>("kernel"),
    member<&About::model>("model", "empty if unknown"),
    member<&About::board>("board", "null if unknown"),
    member<&About::parts>("parts"),
};

constexpr Member kInterface[] = {
    member<&InterfaceRow::name>("name"),
    member<&InterfaceRow::up>("up"),
    member<&InterfaceRow::carrier>("carrier"),
    member<&InterfaceRow::addresses>("addresses"),
};

constexpr Member kRoute[] = {
    member<&RouteRow::destination>("destination"),
    member<&RouteRow::gateway>("gateway"),
    member<&RouteRow::interface>("interface"),
    member<&RouteRow::metric>("metric"),
};

constexpr Member kNetwork[] = {
    member<&NetworkState::interfaces>("interfaces"),
    member<&NetworkState::routes>("routes"),
    member<&NetworkState::trouble>("trouble"),
};

}  // namespace

constexpr codec::Row LogRecord::kRow = {"LogRecord", kRecord};
constexpr codec::Row LogPage::kRow = {"Log", kPage};
constexpr codec::Row PartRow::kRow = {"", kPart, "A library of the program."};
constexpr codec::Row BoardRow::kRow = {"", kBoard};
constexpr codec::Row About::kRow = {"About", kAbout};
constexpr codec::Row InterfaceRow::kRow = {"", kInterface};
constexpr codec::Row RouteRow::kRow = {"", kRoute};
constexpr codec::Row NetworkState::kRow = {"", kNetwork};

}  // namespace adit::api
