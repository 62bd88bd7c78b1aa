#include "api/kept_runs.hpp"

namespace adit::api {
namespace {

using codec::Member;
using codec::member;
using codec::Row;

constexpr Member kMapAges[] = {
    member<&MapAges::robot>("robot", "empty for merged maps"),
    member<&MapAges::ages>("ages",
                           "of the oldest undelivered map, in seconds; 0 if all are delivered; null if no "
                           "map came for a minute"),
};

constexpr Member kAttentionStep[] = {
    member<&AttentionStep::at>("at", "seconds since 1970"),
    member<&AttentionStep::came>("came", "whether the alarm began; false if it ended"),
    member<&AttentionStep::sentence>("sentence"),
};

constexpr Member kHistory[] = {
    member<&History::spacing>("spacing", "least seconds between two samples"),
    member<&History::at>("at", "seconds since 1970, oldest first; all other lists have the same length"),
    member<&History::sent_mbit>("sent_mbit", "megabits a second to the Command Post"),
    member<&History::queued_bytes>("queued_bytes", "bytes of queued maps"),
    member<&History::scoring_ms>("scoring_ms", "duration of the last answer"),
    member<&History::mapping_ms>("mapping_ms", "duration of the last answer"),
    member<&History::throttled>("throttled", "number of answers of 429 since the previous sample"),
    member<&History::robots>("robots", "age of the newest map at the Command Post"),
    member<&History::attention>("attention", "begins and ends of alarms that needed the operator"),
};

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
    member<&RunList::unreadable>("unreadable", "why a run may be missing from the list, or empty"),
};

}  // namespace

constexpr Row MapAges::kRow = codec::complete<MapAges>({"", kMapAges});
constexpr Row AttentionStep::kRow = codec::complete<AttentionStep>({"", kAttentionStep});
constexpr Row History::kRow =
    codec::complete<History>({"History", kHistory, "The plots of a run, one item for each sample."});
constexpr Row RunRow::kRow =
    codec::complete<RunRow>({"KeptRun", kRunRow, "A stored run: its map, tracks and plots."});
constexpr Row RunList::kRow = codec::complete<RunList>({"KeptRuns", kRunList});

}  // namespace adit::api
