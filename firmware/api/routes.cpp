#include "api/routes.hpp"

#include <optional>

#include "api/box_routes.hpp"
#include "api/clock_routes.hpp"
#include "api/handle.hpp"
#include "api/kept_runs_routes.hpp"
#include "api/map_routes.hpp"
#include "api/network_routes.hpp"
#include "api/page_routes.hpp"
#include "api/report_routes.hpp"
#include "api/run_routes.hpp"
#include "api/session_routes.hpp"
#include "api/settings_routes.hpp"
#include "api/spare_routes.hpp"
#include "api/update_routes.hpp"
#include "spare/sealed.hpp"

namespace adit::api {
namespace {

using enum Who;

template <std::size_t most>
constexpr Body kJson{"application/json", most};
/// No form of a page from elsewhere can send it without a CORS preflight, as with JSON.
constexpr Body kBundle{"application/octet-stream", update::kLargestBundle, true};
constexpr Body kExport{"application/octet-stream", spare::kLargestExport, true};

/// What follows the handle is for describe.jq, which reads it here; the program has none of it:
/// of the body, which of openapi.json's `bodies` it is; tag and summary; of the answer, what it means and
/// what it is: a schema, [schema], one of `answers` or a Content-Type, behind its status where that is not
/// 200; the refusals beside those that follow from who may and from the body; the `parameters` of path and
/// query.
consteval Route get(std::string_view path, Who who, Handle handle, std::string_view, std::string_view,
                    std::string_view, std::string_view, std::string_view = {}, std::string_view = {}) {
  return {"GET", path, who, {}, handle};
}

consteval Route post(std::string_view path, Who who, Body body, Handle handle, std::string_view,
                     std::string_view, std::string_view, std::string_view, std::string_view,
                     std::string_view = {}, std::string_view = {}) {
  return {"POST", path, who, body, handle};
}

constexpr Route kRoutes[] = {
    get("/", Open, by<&PageRoutes::file>(), "page", "The page.", "The page.", "text/html; charset=utf-8"),
    get("/display", Open, by<&PageRoutes::file>(), "page", "The run for a wall: no controls.", "The page.",
        "text/html; charset=utf-8"),
    get("/help", Open, by<&PageRoutes::file>(), "page", "What each alarm means, and what to do.", "The page.",
        "text/html; charset=utf-8"),
    get("/runs", Open, by<&PageRoutes::file>(), "page", "The runs that are kept.", "The page.",
        "text/html; charset=utf-8"),
    get("/setup", Open, by<&PageRoutes::file>(), "page", "What is set up.", "The page.",
        "text/html; charset=utf-8"),
    get("/system", Open, by<&PageRoutes::file>(), "page", "The page of the box itself.", "The page.",
        "text/html; charset=utf-8"),
    get("/metrics", Viewer, by<&BoxRoutes::metrics>(), "box",
        "Metrics for Prometheus, in its text format 0.0.4.", "The metrics.",
        "text/plain; version=0.0.4; charset=utf-8"),
    get("/adit/openapi.json", Open, by<&PageRoutes::description>(), "box", "This description.",
        "OpenAPI 3.1.", "Description"),
    get("/adit/session", OwnPage, by<&SessionRoutes::session>(), "login",
        "Who the one is that asks, for anybody.", "Who it is.", "WhoAsks"),
    post("/adit/login", OwnPage, kJson<4096>, by<&SessionRoutes::log_in>(), "Login", "login",
         "Shows a password; the cookie adit comes with the answer.", "Logged in.", "LoggedIn", "400 409 429"),
    post("/adit/password", OperatorOrSetUp, kJson<4096>, by<&SessionRoutes::change_password>(), "NewPassword",
         "login", "Sets a role's password, and ends the role's other sessions.", "It is set.", "PasswordSet",
         "400 409 429"),
    get("/adit/sessions", Operator, by<&SessionRoutes::sessions>(), "login",
        "Who is logged in, the newest first.", "The sessions.", "[Session]"),
    post("/adit/sessions/{session}/end", Operator, kJson<4096>, by<&SessionRoutes::end>(), "Nothing", "login",
         "Ends a session.", "It is done.", "SessionNumber", "404", "session"),
    get("/adit/run", Viewer, by<&RunRoutes::run>(), "run", "How all stands.", "The run.", "RunView"),
    get("/adit/events", Viewer, by<&RunRoutes::events>(), "run",
        "The same as server-sent events: whole at once, then what changes, at least every 2 s.",
        "The data of an event without a type is a RunView; that of one of type patch is what it changes by: "
        "a "
        "JSON merge patch in which null is a value, and a list of rows is patched by places: an object of "
        "length, kept ([[to, from, count]]) and rows (by places: patches, and new rows).",
        "text/event-stream", "503"),
    get("/adit/markers", Viewer, by<&MapRoutes::markers>(), "map",
        "The markers as the Command Post was last told of them.", "The markers.", "Markers", "400",
        "since_version"),
    get("/adit/tracks", Viewer, by<&MapRoutes::tracks>(), "map", "Where each robot was in this run.",
        "The tracks.", "Tracks", "400", "since_time"),
    get("/adit/history", Viewer, by<&KeptRunsRoutes::history>(), "map",
        "The plots of this run: the link, and how old each robot's map is at the Command Post.",
        "The samples, oldest first.", "History", "400", "since_sample"),
    get("/adit/map", Viewer, by<&MapRoutes::layers>(), "map", "The layers of the picture of the maps.",
        "The layers.", "Map", "400", "since_map_version"),
    get("/adit/map/{kind}/{robot}/{level}/{x}/{y}.png", Viewer, by<&MapRoutes::tile>(), "map",
        "One tile; what is unknown is transparent.", "The tile.", "204 image/png", "400 404 503",
        "kind robot level x y at low high from to"),
    get("/adit/reports", Viewer, by<&ReportRoutes::list>(), "reports",
        "Every report of every run, or of one, oldest first.", "The reports.", "[Report]", "400", "run"),
    post("/adit/reports", Operator, kJson<65536>, by<&ReportRoutes::compose>(), "ComposedReport", "reports",
         "A report that the operator composed.", "It is done.", "202 ReportNumber", "400 409"),
    get("/adit/reports.csv", Viewer, by<&ReportRoutes::csv>(), "reports", "The same for spreadsheets.",
        "RFC 4180.", "text/csv; charset=utf-8; header=present", "400", "run"),
    get("/adit/reports/{number}", Viewer, by<&ReportRoutes::one>(), "reports",
        "One report, with its history and the answer that is kept.", "The report.", "ReportDetail", "404",
        "report"),
    post("/adit/reports/{number}/withdraw", Operator, kJson<65536>,
         by<&ReportRoutes::judge<Action::Withdraw>>(), "Nothing", "reports",
         "Never send it: a held or waiting one.", "It is done.", "ReportNumber", "404 409", "report"),
    post("/adit/reports/{number}/send", Operator, kJson<65536>, by<&ReportRoutes::judge<Action::Send>>(),
         "Nothing", "reports",
         "Send it, on the operator's word: a held or withdrawn one, one in doubt, a refused one.",
         "It is done.", "ReportNumber", "404 409", "report"),
    post("/adit/reports/{number}/hold", Operator, kJson<65536>, by<&ReportRoutes::judge<Action::Hold>>(),
         "Nothing", "reports", "Keep it back until the operator's further word: a waiting one.",
         "It is done.", "ReportNumber", "404 409", "report"),
    post("/adit/reports/{number}/done", Operator, kJson<65536>, by<&ReportRoutes::judge<Action::CallDone>>(),
         "Nothing", "reports", "Nothing is left to do about one in doubt.", "It is done.", "ReportNumber",
         "404 409", "report"),
    post("/adit/reports/{number}/resubmit", Operator, kJson<65536>,
         by<&ReportRoutes::judge<Action::Resubmit>>(), "Nothing", "reports",
         "The same once more, as a new report: a finished one.", "It is done.", "ReportNumber", "404 409",
         "report"),
    post("/adit/rejected/{number}/send", Operator, kJson<1024>,
         by<&RunRoutes::rejected<RejectedAction::Send>>(), "Nothing", "run",
         "Sends what the Command Post would not take once more. 409 where something newer that says all of "
         "it was sent since.",
         "It is done.", "RejectedNumber", "404 409", "rejected"),
    post("/adit/rejected/{number}/discard", Operator, kJson<1024>,
         by<&RunRoutes::rejected<RejectedAction::Discard>>(), "Nothing", "run",
         "Forgets what the Command Post would not take.", "It is done.", "RejectedNumber", "404 409",
         "rejected"),
    post("/adit/alarms/acknowledge", Operator, kJson<1024>, by<&RunRoutes::acknowledge>(), "AlarmId", "run",
         "An operator has seen an alarm: it is quiet until it gets worse or comes again. 409 where there is "
         "none "
         "of that id any more.",
         "It is done.", "AlarmAcknowledged", "400 409"),
    post("/adit/identify", Operator, kJson<1024>, by<&RunRoutes::identify>(), "Seconds", "run",
         "All lights flash twice a second, to tell this box from others.", "They flash.", "IdentifyUntil",
         "400"),
    get("/adit/runs", Viewer, by<&KeptRunsRoutes::list>(), "runs",
        "The runs whose map, tracks and plots are kept, the latest first.", "The runs.", "KeptRuns"),
    post("/adit/runs", Operator, kJson<65536>, by<&RunRoutes::begin_run>(), "Nothing", "run",
         "A new run begins: what was not sent in the old one is held, but for what was posted in the last 10 "
         "s.",
         "It is done.", "RunNumber"),
    get("/adit/runs/{key}", Viewer, by<&KeptRunsRoutes::one>(), "runs", "One of them.", "The run.", "KeptRun",
        "404", "kept_run"),
    get("/adit/runs/{key}/map", Viewer, by<&KeptRunsRoutes::layers>(), "runs",
        "The layers of its picture, as it was at last.", "The layers.", "Map", "400 404 503",
        "kept_run since_map_version"),
    get("/adit/runs/{key}/map/{kind}/{robot}/{level}/{x}/{y}.png", Viewer, by<&KeptRunsRoutes::tile>(),
        "runs", "One tile of it.", "The tile.", "image/png", "400 404 503",
        "kept_run kind robot level x y at low high from to"),
    get("/adit/runs/{key}/tracks", Viewer, by<&KeptRunsRoutes::tracks>(), "runs",
        "Where each robot was in it.", "The tracks.", "Tracks", "404 503", "kept_run"),
    get("/adit/runs/{key}/history", Viewer, by<&KeptRunsRoutes::plots>(), "runs", "Its plots.",
        "The samples.", "History", "404 503", "kept_run"),
    get("/adit/runs/{key}/report.html", Viewer, by<&KeptRunsRoutes::report>(), "runs",
        "Its report to print: one file that loads nothing.", "The report.", "text/html; charset=utf-8", "404",
        "kept_run"),
    post("/adit/runs/{key}/delete", Operator, kJson<1024>, by<&KeptRunsRoutes::remove>(), "Nothing", "runs",
         "Forgets its map, tracks and plots: never the present one's. Its reports stay.", "It is gone.",
         "KeptRunKey", "404 409", "kept_run"),
    get("/adit/log", Viewer, by<&BoxRoutes::log>(), "box",
        "The last records of the log, oldest first: at most 2000.", "The records.", "Log", "400",
        "log_level log_text log_since"),
    get("/adit/log.txt", Viewer, by<&BoxRoutes::log_text>(), "box", "The same as a file.",
        "A line for each record.", "text/plain; charset=utf-8", "400", "log_level log_text log_since"),
    get("/adit/about", Viewer, by<&BoxRoutes::about>(), "box", "What the box and its program are made of.",
        "About.", "About"),
    get("/adit/bundle", Operator, by<&BoxRoutes::bundle>(), "box",
        "All that helps to find a fault, without tokens and passwords: a .tar.gz of at most 10 MB.",
        "The support bundle.", "application/gzip"),
    get("/adit/settings", Viewer, by<&SettingsRoutes::shown>(), "settings",
        "What the box runs with, and what a form for it needs.", "The settings.", "Setup"),
    post("/adit/settings", Operator, kJson<262144>, by<&SettingsRoutes::save>(), "NewSettings", "settings",
         "Saves and applies settings.", "They are saved, and about to be applied.", "Changes", "400 409 503"),
    post("/adit/settings/check", Operator, kJson<262144>, by<&SettingsRoutes::check>(), "SettingsToCheck",
         "settings", "What is wrong with settings, and what they would change. Changes nothing.",
         "Looked at.", "Checked", "400"),
    get("/adit/settings/export", Viewer, by<&SettingsRoutes::exported>(), "settings",
        "The settings file, for a download.", "The file. No token is in it.", "Settings"),
    get("/adit/network", Viewer, by<&NetworkRoutes::shown>(), "network",
        "The box's own addresses, and a change of them that waits.", "As they are.", "Network"),
    post("/adit/network", Operator, kJson<4096>, by<&NetworkRoutes::change>(), "Numbers", "network",
         "Changes them for now: taken back unless it is confirmed in time.", "It is tried.", "Network",
         "409"),
    post("/adit/network/check", Operator, kJson<4096>, by<&NetworkRoutes::check>(), "Numbers", "network",
         "What is wrong with addresses, and what they would change. Changes nothing.", "Looked at.",
         "Checked"),
    post("/adit/network/confirm", Operator, kJson<4096>, by<&NetworkRoutes::confirm>(), "Nothing", "network",
         "The change stays. Only by the new address.", "It stays.", "Network", "409"),
    post("/adit/network/back", Operator, kJson<4096>, by<&NetworkRoutes::take_back>(), "Nothing", "network",
         "The change is taken back now.", "It is on its way back.", "Network", "409"),
    get("/adit/update", Viewer, by<&UpdateRoutes::shown>(), "box",
        "Which version runs, and how an update of the box stands.", "As it is.", "Update"),
    post("/adit/update", Operator, kBundle, by<&UpdateRoutes::receive>(), "Bundle", "box",
         "Takes an update, has it checked, and installed into the slot that does not run.",
         "It is whole, and is being checked.", "Update", "409 503", "again"),
    post("/adit/update/stick", Operator, kJson<1024>, by<&UpdateRoutes::install_from_stick>(), "FromStick",
         "box", "Installs the update that is on the box's USB stick.", "It is being checked.", "Update",
         "400 409 503"),
    post("/adit/update/restart", Operator, kJson<1024>, by<&UpdateRoutes::restart>(), "Restart", "box",
         "Restarts the box, to use what was installed.", "It restarts.", "Update", "400 409 503"),
    post("/adit/update/back", Operator, kJson<1024>, by<&UpdateRoutes::go_back>(), "Restart", "box",
         "Restarts the box into the slot that was good last, where another one runs (`stray`).",
         "It restarts.", "Update", "400 409 503"),
    post("/adit/update/stay", Operator, kJson<1024>, by<&UpdateRoutes::stay>(), "Nothing", "box",
         "The slot that runs is the one to keep, where another one was good last (`stray`).",
         "It is being written down.", "Update", "409 503"),
    get("/adit/clock", Viewer, by<&ClockRoutes::shown>(), "box", "The time of day, and who set it.",
        "The clock.", "Clock"),
    post("/adit/clock", Operator, kJson<1024>, by<&ClockRoutes::set>(), "ClockToSet", "box",
         "Sets the time of day, by the clock of the one who asks.", "It is about to be set.", "Clock",
         "400 409"),
    get("/adit/spare", Operator, by<&SpareRoutes::shown>(), "box",
        "Whether the box rests, the code of its export, and what it took in of another box.", "As it is.",
        "Spare"),
    post("/adit/spare/rest", Operator, kJson<1024>, by<&SpareRoutes::rest>(), "Nothing", "box",
         "From now on the box takes nothing and sends nothing, so that a spare can take over; also after a "
         "power cut.",
         "It is about to rest.", "Spare", "409 503"),
    post("/adit/spare/wake", Operator, kJson<1024>, by<&SpareRoutes::wake>(), "Nothing", "box",
         "The box goes on. Only where its spare did not take over.", "It is about to.", "Spare", "409 503"),
    get("/adit/spare/export", Operator, by<&SpareRoutes::exported>(), "box",
        "The export for the spare, which its code opens: ledger, settings and tokens. Only while the box "
        "rests.",
        "The export.", "application/octet-stream", "409 503"),
    post("/adit/spare/to-stick", Operator, kJson<1024>, by<&SpareRoutes::to_stick>(), "Nothing", "box",
         "Writes the export to the stick in the box. Only while the box rests.", "It is about to be written.",
         "Spare", "409 503"),
    post("/adit/spare/from-stick", Operator, kJson<1024>, by<&SpareRoutes::from_stick>(), "ExportOnStick",
         "box", "Takes in another box's export that is on the stick in the box. Nothing changes yet.",
         "It is about to be read.", "Spare", "400 409 503"),
    post("/adit/spare/take", Operator, kExport, by<&SpareRoutes::take_in>(), "Export", "box",
         "Takes in another box's export. Nothing changes yet.", "It waits for its code.", "Spare", "409"),
    post("/adit/spare/open", Operator, kJson<1024>, by<&SpareRoutes::open>(), "ExportCode", "box",
         "Opens the export that was taken in, and shows what is in it. Nothing changes yet.", "It is opened.",
         "Spare", "400 409"),
    post("/adit/spare/forget", Operator, kJson<1024>, by<&SpareRoutes::forget>(), "Nothing", "box",
         "Forgets what was taken in.", "It is forgotten.", "Spare", "409"),
    post("/adit/spare/take-over", Operator, kJson<1024>, by<&SpareRoutes::take_over>(), "TakeOver", "box",
         "The box goes on where the one that made the export came to rest: with its reports, settings and "
         "tokens.",
         "It is about to.", "Spare", "400 409 503"),
    get("/adit/test", Viewer, by<&NetworkRoutes::tested>(), "network", "The Test, step by step.",
        "As far as it is.", "Test"),
    post("/adit/test", Operator, kJson<4096>, by<&NetworkRoutes::begin_test>(), "Candidate", "network",
         "Begins the Test, of what is in use or of what is named. It spends no report; the run goes on.",
         "It has begun.", "Test", "400 409"),
    post("/adit/tokens", Operator, kJson<262144>, by<&SettingsRoutes::set_token>(), "Token", "settings",
         "Keeps and applies a token, or removes it.", "It is kept, and about to be applied.", "TokenSet",
         "400 409 503"),
    post("/adit/course", Operator, kJson<262144>, by<&SettingsRoutes::switch_course>(), "Course", "settings",
         "Switches to a course's Command Post.", "It is about to be applied.", "Changes", "400 409 503"),
    post("/adit/logout", Viewer, kJson<4096>, by<&SessionRoutes::log_out>(), "Nothing", "login",
         "Ends the session of the one who asks.", "Nobody any more.", "LoggedOut"),
    post("/adit/reset", Operator, kJson<4096>, by<&SessionRoutes::reset>(), "OwnPassword", "settings",
         "Back to how the box was given. The reports stay.",
         "Settings, tokens, passwords and sessions are gone.", "WasReset", "400 409 429 503"),
};

/// The parameters in `path`, where it is one of `pattern`.
std::optional<std::vector<std::string>> parameters_in(std::string_view pattern, std::string_view path) {
  std::vector<std::string> found;
  while (true) {
    const auto wanted = pattern.substr(0, pattern.find('/')), given = path.substr(0, path.find('/'));
    if (wanted.starts_with('{')) {
      const auto ending = wanted.substr(wanted.find('}') + 1);
      if (!given.ends_with(ending) || given.size() == ending.size()) return std::nullopt;
      found.emplace_back(given.substr(0, given.size() - ending.size()));
    } else if (wanted != given) {
      return std::nullopt;
    }
    const bool last = wanted.size() == pattern.size();
    if (last != (given.size() == path.size())) return std::nullopt;
    if (last) return found;
    pattern.remove_prefix(wanted.size() + 1);
    path.remove_prefix(given.size() + 1);
  }
}

/// "GET, HEAD, POST": what reads comes first, as in the table.
void allow(std::string& methods, std::string_view method) {
  if (!methods.empty()) methods += ", ";
  methods += method == "GET" ? kReading : method;
}

}  // namespace

std::span<const Route> routes() {
  return kRoutes;
}

Match match(const Handlers& handlers, const intake::RequestHead& head) {
  Match match;
  if (only_reads(head)) match.who = Who::Viewer;
  for (const Route& route : kRoutes) {
    auto parameters = parameters_in(route.path, head.path());
    if (!parameters || !route.handle.served(handlers)) continue;
    allow(match.allowed, route.method);
    const bool fits = route.method == "GET" ? only_reads(head) : route.method == head.method();
    if (fits) return {&route, std::move(*parameters), {}, route.who};
    if (route.who < Who::OperatorOrSetUp) match.who = route.who;  // who may know it, may know that
  }
  return match;
}

}  // namespace adit::api
