#include "api/kept_runs.hpp"

namespace adit::api {
namespace {

using codec::Member;
using codec::member;
using codec::Row;

constexpr Member kRunRow[] = {
    member<&RunRow::key>("key", "key of the run in URIs"),
    member<&RunRow::run>("run", "number of the run, as in its reports"),
    member<&RunRow::id>("id", "the Command Post's name of the run, or empty"),
    member<&RunRow::course>("course", "empty if no course was in use"),
    member<&RunRow::post>("post", "the Command Post's address and port"),
    member<&RunRow::team>("team"),
    member<&RunRow::began>("began", "seconds since 1970: first status of the run"),
    member<&RunRow::last>("last", "seconds since 1970: last change of the stored run"),
    member<&RunRow::stamp>("stamp",
                           "`last` by the clock for time stamps, which is never set; null if unknown"),
    member<&RunRow::score>("score", "from the last status"),
    member<&RunRow::remaining_reports>("remaining_reports", "from the last status"),
    member<&RunRow::robots>("robots"),
    member<&RunRow::bytes>("bytes", "size on the disk"),
    member<&RunRow::is_present>("is_present"),
};

constexpr Member kRunList[] = {
    member<&RunList::runs>("runs", "latest first"),
    member<&RunList::bytes>("bytes", "size of all runs on the disk"),
    member<&RunList::trouble>("trouble", "why runs cannot be stored now, or empty"),
};

}  // namespace

constexpr Row RunRow::kRow = {"KeptRun", kRunRow, "A stored run: its map, tracks and plots."};
constexpr Row RunList::kRow = {"KeptRuns", kRunList};

}  // namespace adit::api
