#include "api/kept_runs.hpp"

namespace adit::api {
namespace {

using codec::Member;
using codec::member;
using codec::Row;

constexpr Member kRunRow[] = {
    member<&RunRow::key>("key", "what it is asked for by"),
    member<&RunRow::run>("run", "as in its reports"),
    member<&RunRow::id>("id", "as the Command Post names it; or empty"),
    member<&RunRow::course>("course", "empty: none was in use"),
    member<&RunRow::post>("post", "the Command Post's address and port"),
    member<&RunRow::team>("team"),
    member<&RunRow::began>("began", "seconds since 1970: when the box first knew of it"),
    member<&RunRow::last>("last", "seconds since 1970: when something was last written of it"),
    member<&RunRow::stamp>("stamp", "`last` by the clock for stamps, which nobody sets; null: not known"),
    member<&RunRow::score>("score", "as last heard"),
    member<&RunRow::remaining_reports>("remaining_reports", "as last heard"),
    member<&RunRow::robots>("robots"),
    member<&RunRow::bytes>("bytes", "that it takes on the disk"),
    member<&RunRow::is_present>("is_present"),
};

constexpr Member kRunList[] = {
    member<&RunList::runs>("runs", "the latest first"),
    member<&RunList::bytes>("bytes", "that all of them take on the disk"),
    member<&RunList::trouble>("trouble", "why nothing is written now; or empty"),
};

}  // namespace

constexpr Row RunRow::kRow = {"KeptRun", kRunRow, "A run whose map, tracks and plots are kept."};
constexpr Row RunList::kRow = {"KeptRuns", kRunList};

}  // namespace adit::api
