#include "api/history.hpp"

namespace adit::api {
namespace {

using codec::Member;
using codec::member;
using codec::Row;

constexpr Member kMapAges[] = {
    member<&MapAges::robot>("robot", "empty: merged maps"),
    member<&MapAges::ages>("ages", "seconds; null: it has none"),
};

constexpr Member kAttentionStep[] = {
    member<&AttentionStep::at>("at", "seconds since 1970"),
    member<&AttentionStep::came>("came", "false: it went"),
    member<&AttentionStep::sentence>("sentence"),
};

constexpr Member kHistory[] = {
    member<&History::spacing>("spacing", "seconds between two samples, at least"),
    member<&History::at>("at", "seconds since 1970, oldest first; all other lists are as long"),
    member<&History::sent_mbit>("sent_mbit", "megabits a second to the Command Post"),
    member<&History::queued_bytes>("queued_bytes", "of maps that wait"),
    member<&History::scoring_ms>("scoring_ms", "how long the last answer took"),
    member<&History::mapping_ms>("mapping_ms", "how long the last answer took"),
    member<&History::throttled>("throttled", "how often the Command Post said 429 since the sample before"),
    member<&History::robots>("robots", "how old the newest map is that the Command Post has"),
    member<&History::attention>("attention", "what needed the operator: when it came, when it went"),
};

}  // namespace

constexpr Row MapAges::kRow = {"", kMapAges};
constexpr Row AttentionStep::kRow = {"", kAttentionStep};
constexpr Row History::kRow = {"History", kHistory, "The plots of a run, one item for each sample."};

}  // namespace adit::api
