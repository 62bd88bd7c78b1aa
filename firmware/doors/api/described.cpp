// OpenAPI's schemas of the rows, computed by the compiler into section "schemas" of the object file
// (CMakeLists.txt). It is linked into no program and need not run, so it can be built for another machine.
#include "codec/schemas.hpp"

// NOLINTBEGIN(bugprone-suspicious-include): the sources hold the descriptions.
#include "alarms/alarm.cpp"
#include "alarms/arrival.cpp"
#include "alarms/verdict.cpp"
#include "api/box_rows.cpp"
#include "api/kept_runs.cpp"
#include "api/map_json.cpp"
#include "api/run_view.cpp"
#include "api/scene.cpp"
#include "api/settings_rows.cpp"
#include "facts/rows.cpp"
#include "network/numbers_rows.cpp"
#include "update/messages.cpp"
// NOLINTEND(bugprone-suspicious-include)

namespace adit::api {
namespace {

template <class T>
constexpr const codec::Schema* of = &codec::KindOf<T>::schema;

constexpr codec::Schemas kSchemas({of<RunView>,        of<ReportDetail>, of<MarkerChanges>, of<Tracks>,
                                   of<MapView>,        of<CoveredView>,  of<History>,       of<RunList>,
                                   of<LogPage>,        of<NetworkView>,  of<UpdateView>,    of<SessionRow>,
                                   of<SessionView>,    of<SetupView>,    of<CheckView>,     of<ChangesView>,
                                   of<TestView>,       of<About>,        of<ClockView>,     of<SpareView>,
                                   of<CertificateView>});

[[gnu::used, gnu::section("schemas")]] constexpr std::array kText = kSchemas.text();

}  // namespace
}  // namespace adit::api
