#include "api/history.hpp"

namespace adit::api {
namespace {

using codec::Member;
using codec::member;
using codec::Row;

constexpr Member kMapAges[] = {
    member<&MapAges::robot>("robot", "empty for merged maps"),
    member<&MapAges::ages>("ages", "seconds; null if the Command Post has no map"),
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

}  // namespace

constexpr Row MapAges::kRow = {"", kMapAges};
constexpr Row AttentionStep::kRow = {"", kAttentionStep};
constexpr Row History::kRow = {"History", kHistory, "The plots of a run, one item for each sample."};

}  // namespace adit::api
