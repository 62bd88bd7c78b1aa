#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>

#include "access/certificate.hpp"
#include "api/answers.hpp"
#include "api/box_routes.hpp"
#include "api/certificate.hpp"
#include "api/clock.hpp"
#include "api/map_routes.hpp"
#include "api/page_routes.hpp"
#include "api/report_routes.hpp"
#include "api/route.hpp"
#include "api/run_routes.hpp"
#include "api/self_test.hpp"
#include "api/session_routes.hpp"
#include "api/settings_routes.hpp"
#include "spare/sealed.hpp"

namespace adit::api {

/// The class of a handler's function, and the type of its parameter, or void.
template <class Function>
struct Signature;
template <class Class, class Gives, class... Parameters>
struct Signature<Gives (Class::*)(Parameters...)> {
  using Handler = Class;
  using Argument = std::remove_cvref_t<std::tuple_element_t<0, std::tuple<Parameters..., void>>>;
};
template <class Class, class Gives, class... Parameters>
struct Signature<Gives (Class::*)(Parameters...) const> : Signature<Gives (Class::*)(Parameters...)> {};
template <class Class, class Gives, class... Parameters>
struct Signature<Gives (*)(Class&, Parameters...)>
    : Signature<Gives (std::remove_const_t<Class>::*)(Parameters...)> {};

/// The result of a handler's function, as the Answer if it is a row, a refusal or the success of an action.
template <class Handler, class Result>
auto answer_result(const Handler& handler, Result result) {
  if constexpr (std::same_as<Result, icd::Checked<void>>) {
    return answer_after(handler, result);
  } else if constexpr (requires { result.error(); }) {
    return result ? answer_result(handler, *std::move(result)) : refusal_answer(result.error());
  } else if constexpr (requires { Result::kRow; }) {
    return uncached_answer(result);
  } else {
    return result;
  }
}

template <auto function, auto reader>
auto call_of(const Handlers& handlers, const Call& call) {
  using Argument = Signature<decltype(function)>::Argument;
  auto& handler = *std::get<typename Signature<decltype(function)>::Handler*>(handlers);
  if constexpr (!std::is_null_pointer_v<decltype(reader)>) {
    const auto read = reader(call.body);
    return read ? answer_result(handler, std::invoke(function, handler, *read))
                : refusal_answer(read.error());
  } else if constexpr (std::is_void_v<Argument>) {
    return answer_result(handler, std::invoke(function, handler));
  } else if constexpr (std::integral<Argument>) {
    const auto number = icd::number_in<Argument>(call.parameters.front());
    return number ? answer_result(handler, std::invoke(function, handler, *number))
                  : refusal_answer(nothing_at(call.head.path()));
  } else if constexpr (std::same_as<Argument, std::string>) {
    return answer_result(handler, std::invoke(function, handler, call.body));
  } else if constexpr (std::same_as<Argument, intake::RequestHead>) {
    return answer_result(handler, std::invoke(function, handler, call.head));
  } else if constexpr (std::is_void_v<decltype(std::invoke(function, handler, call))>) {
    return std::invoke(function, handler, call);
  } else {
    return answer_result(handler, std::invoke(function, handler, call));
  }
}

/// Wraps a function on one of the Handlers: a member, or with the handler as first parameter. Its parameter
/// is what `reader` reads from the body; without a reader the number in the path (404 if it is none), the
/// body (std::string), the RequestHead or the Call. It returns the Answer, a row, a refusal, the success of
/// an action (answer_after()), void (then answers by Call::responder), or a receiver of the body.
template <auto function, auto reader = nullptr>
consteval Handle handle_of() {
  constexpr auto kCall = call_of<function, reader>;
  using Gives = std::invoke_result_t<decltype(kCall), const Handlers&, const Call&>;
  if constexpr (std::same_as<Gives, intake::Answer>) {
    return {.answer = kCall};
  } else if constexpr (std::is_void_v<Gives>) {
    return {.answer_later = kCall};
  } else {
    return {.begin = kCall};
  }
}

namespace {

using enum RouteAccess;

template <std::size_t most>
constexpr Body kJson{"application/json", most};
/// Like JSON, this type cannot be sent by another site's form without a CORS preflight.
constexpr Body kBundle{"application/octet-stream", update::kLargestBundle, true};
constexpr Body kCertificate{"application/octet-stream", access::kLargestUpload, true};
constexpr Body kExport{"application/octet-stream", spare::kLargestExport, true};

/// The only possible flag of a body.
icd::Checked<bool> flag_in(const std::string& body, std::string_view name) {
  if (body.empty()) return false;
  return read_body<bool>(body, [name](const codec::Field& root) {
    const codec::Field field = root.member(name);
    return field.is_absent() && root.is<codec::Value::Object>() ? false : field.truth();
  });
}
icd::Checked<bool> read_again_flag(const std::string& body) {
  return flag_in(body, "again");
}
icd::Checked<bool> anyway_in(const std::string& body) {
  return flag_in(body, "anyway");
}
icd::Checked<std::string> name_in(const std::string& body) {
  return read_text(body, "name");
}
icd::Checked<double> time_in(const std::string& body) {
  return read_body<double>(body, [](const codec::Field& root) { return root.member("time").number(); });
}

/// The arguments after the handle are for describe.jq, which reads this file; the program does not contain
/// them. For the body: its name in openapi.json's `bodies`. Then tag and summary. For the answer: its
/// meaning, and a schema, [schema], one of `answers` or a Content-Type, after its status if that is not 200.
/// Then the refusals beyond those of `who` and the body, and the `parameters` of path and query.
consteval Route get(std::string_view path, RouteAccess who, Handle handle, std::string_view, std::string_view,
                    std::string_view, std::string_view, std::string_view = {}, std::string_view = {}) {
  return {"GET", path, who, {}, handle};
}

consteval Route post(std::string_view path, RouteAccess who, Body body, Handle handle, std::string_view,
                     std::string_view, std::string_view, std::string_view, std::string_view,
                     std::string_view = {}, std::string_view = {}) {
  return {"POST", path, who, body, handle};
}

constexpr Route kRoutes[] = {
    get("/", Open, handle_of<&PageRoutes::file>(), "page", "The run's page.", "The page.",
        "text/html; charset=utf-8"),
    get("/display", Open, handle_of<&PageRoutes::file>(), "page",
        "The run's page for a wall display, without controls.", "The page.", "text/html; charset=utf-8"),
    get("/help", Open, handle_of<&PageRoutes::file>(), "page", "The meaning of each alarm, and its remedy.",
        "The page.", "text/html; charset=utf-8"),
    get("/runs", Open, handle_of<&PageRoutes::file>(), "page", "The page of stored runs.", "The page.",
        "text/html; charset=utf-8"),
    get("/setup", Open, handle_of<&PageRoutes::file>(), "page", "The set-up page.", "The page.",
        "text/html; charset=utf-8"),
    get("/system", Open, handle_of<&PageRoutes::file>(), "page", "The system page.", "The page.",
        "text/html; charset=utf-8"),
    get("/metrics", Viewer, handle_of<&BoxRoutes::metrics>(), "box",
        "Metrics for Prometheus, in its text format 0.0.4.", "The metrics.",
        "text/plain; version=0.0.4; charset=utf-8"),
    get("/adit/openapi.json", Open, handle_of<&PageRoutes::description>(), "box", "This description.",
        "OpenAPI 3.1.", "Description"),
    get("/adit/session", OwnPage, handle_of<&SessionRoutes::session>(), "login",
        "The user of this session; needs no login.", "The user.", "SessionView"),
    post("/adit/login", OwnPage, kJson<4096>, handle_of<&SessionRoutes::log_in>(), "Login", "login",
         "Log in with a password. The answer sets the cookie adit-PORT, or adit without a port.",
         "Logged in.", "LoggedIn", "400 409 429"),
    post("/adit/password", OperatorOrSetUp, kJson<4096>, handle_of<&SessionRoutes::change_password>(),
         "NewPassword", "login", "Set a role's password, and end the role's other sessions.",
         "The password is set.", "PasswordSet", "400 409 429"),
    get("/adit/sessions", Operator, handle_of<&SessionRoutes::sessions>(), "login",
        "The open sessions, newest first.", "The sessions.", "[Session]"),
    post("/adit/sessions/{session}/end", Operator, kJson<4096>, handle_of<&SessionRoutes::end>(), "Nothing",
         "login", "End a session.", "Done.", "SessionNumber", "404", "session"),
    get("/adit/run", Viewer, handle_of<&RunRoutes::run>(), "run", "The present state of the run.",
        "The state.", "RunView"),
    get("/adit/events", Viewer, handle_of<&RunRoutes::events>(), "run",
        "The state of the run as server-sent events: first all of it, then changes, at least every 2 s.",
        "An event without a type has a RunView. An event of type patch has a JSON merge patch in which null "
        "is a value. A list of rows is patched by an object with its length, the rows kept ([[to, from, "
        "count]]), and new or patched rows by place.",
        "text/event-stream", "503"),
    get("/adit/markers", Viewer, handle_of<&MapRoutes::markers>(), "map",
        "The markers as last delivered to the Command Post.", "The markers.", "Markers", "400",
        "since_version"),
    get("/adit/tracks", Viewer, handle_of<&MapRoutes::tracks>(), "map",
        "The tracks of the robots in this run.", "The tracks.", "Tracks", "400", "since_time"),
    get("/adit/history", Viewer, handle_of<&KeptRunsRoutes::history>(), "map",
        "The plots of this run: the link, and the age of each robot's map at the Command Post.",
        "The samples, oldest first.", "History", "400", "since_sample"),
    get("/adit/map", Viewer, handle_of<&MapRoutes::layers>(), "map", "The layers of the picture of the maps.",
        "The layers.", "Map", "400", "since_map_version"),
    get("/adit/covered", Viewer, handle_of<&MapRoutes::covered>(), "map",
        "The area that the grids of this run cover.", "The area.", "Covered", "503"),
    get("/adit/map/{kind}/{robot}/{level}/{x}/{y}.png", Viewer, handle_of<&MapRoutes::tile>(), "map",
        "One tile; unknown areas are transparent.", "The tile.", "204 image/png", "400 404 503",
        "kind robot level x y at low high from to"),
    get("/adit/map/{kind}/{robot}/tiles", Viewer, handle_of<&MapRoutes::tiles>(), "map",
        "Several tiles of a layer.", "A line of JSON with the head of each tile, then their PNGs.",
        "application/octet-stream", "400 404", "kind robot tiles at low high from to"),
    get("/adit/reports", Viewer, handle_of<&ReportRoutes::list>(), "reports",
        "The reports of all runs, or of one run, oldest first.", "The reports.", "[Report]", "400", "run"),
    post("/adit/reports", Operator, kJson<65536>, handle_of<&ReportRoutes::compose>(), "ComposedReport",
         "reports", "Submit a report that the operator composed.", "Done.", "202 ReportNumber", "400 409"),
    get("/adit/reports.csv", Viewer, handle_of<&ReportRoutes::csv>(), "reports",
        "The reports for spreadsheets.", "RFC 4180.", "text/csv; charset=utf-8; header=present", "400",
        "run"),
    get("/adit/reports/{number}", Viewer, handle_of<&ReportRoutes::one>(), "reports",
        "One report, with its history and stored answer.", "The report.", "ReportDetail", "404", "report"),
    post("/adit/reports/{number}/withdraw", Operator, kJson<65536>,
         handle_of<&ReportRoutes::decide<Action::Withdraw>>(), "Nothing", "reports",
         "Withdraw a held or queued report: never send it.", "Done.", "ReportNumber", "404 409", "report"),
    post("/adit/reports/{number}/send", Operator, kJson<65536>,
         handle_of<&ReportRoutes::decide<Action::Send>>(), "Nothing", "reports",
         "Send a held, withdrawn or rejected report, or one in doubt, as the operator decided.", "Done.",
         "ReportNumber", "404 409", "report"),
    post("/adit/reports/{number}/hold", Operator, kJson<65536>,
         handle_of<&ReportRoutes::decide<Action::Hold>>(), "Nothing", "reports",
         "Hold a queued report until the operator decides.", "Done.", "ReportNumber", "404 409", "report"),
    post("/adit/reports/{number}/correct", Operator, kJson<65536>, handle_of<&ReportRoutes::correct>(),
         "CorrectedReport", "reports",
         "Send a corrected report instead of a held one, as a new report. The held one is withdrawn.",
         "Done.", "ReportNumber", "400 404 409", "report"),
    post("/adit/reports/{number}/settle", Operator, kJson<65536>,
         handle_of<&ReportRoutes::decide<Action::Settle>>(), "Nothing", "reports",
         "Settle a report in doubt without sending it again.", "Settled.", "ReportNumber", "404 409",
         "report"),
    post("/adit/reports/{number}/resubmit", Operator, kJson<65536>,
         handle_of<&ReportRoutes::decide<Action::Resubmit>>(), "Nothing", "reports",
         "Send a finished report again as a new report.", "Done.", "ReportNumber", "404 409", "report"),
    post("/adit/rejected/{number}/send", Operator, kJson<1024>,
         handle_of<&RunRoutes::change_rejected<RejectedAction::Send>>(), "Nothing", "run",
         "Send a rejected message again. 409 if a newer message that contains all of it was sent since.",
         "Done.", "RejectedNumber", "404 409", "rejected"),
    post("/adit/rejected/{number}/discard", Operator, kJson<1024>,
         handle_of<&RunRoutes::change_rejected<RejectedAction::Discard>>(), "Nothing", "run",
         "Delete a rejected message.", "Done.", "RejectedNumber", "404 409", "rejected"),
    post("/adit/alarms/acknowledge", Operator, kJson<1024>, handle_of<&RunRoutes::acknowledge>(), "AlarmId",
         "run",
         "Acknowledge an alarm: it is quiet until it gets worse or begins again. 409 if there is no alarm "
         "with this id.",
         "Done.", "AlarmAcknowledged", "400 409"),
    post("/adit/identify", Operator, kJson<1024>, handle_of<&RunRoutes::identify>(), "Seconds", "run",
         "Flash all lights twice a second, to identify this box.", "The lights flash.", "IdentifyUntil",
         "400"),
    get("/adit/runs", Viewer, handle_of<&KeptRunsRoutes::list>(), "runs",
        "The stored runs with their map, tracks and plots, latest first.", "The runs.", "KeptRuns"),
    post("/adit/runs", Operator, kJson<65536>, handle_of<&RunRoutes::begin_run>(), "Nothing", "run",
         "Declare a new run. Reports not sent in the old run are held, except those posted in the last 10 s.",
         "Done.", "RunNumber"),
    post("/adit/ledger/new", Operator, kJson<1024>, handle_of<&RunRoutes::begin_ledger>(), "Nothing", "box",
         "Begin a ledger instead of one that cannot be read, whose files are kept. Reports may be lost.",
         "aditd is about to restart with another ledger.", "LedgerKept", "409 503"),
    get("/adit/runs/{key}", Viewer, handle_of<&KeptRunsRoutes::one>(), "runs", "One stored run.", "The run.",
        "KeptRun", "404", "kept_run"),
    get("/adit/runs/{key}/map", Viewer, handle_of<&KeptRunsRoutes::layers>(), "runs",
        "The layers of the run's picture at its end.", "The layers.", "Map", "400 404 503",
        "kept_run since_map_version"),
    get("/adit/runs/{key}/map/{kind}/{robot}/{level}/{x}/{y}.png", Viewer, handle_of<&KeptRunsRoutes::tile>(),
        "runs", "One tile of the run's picture.", "The tile.", "image/png", "400 404 503",
        "kept_run kind robot level x y at low high from to"),
    get("/adit/runs/{key}/map/{kind}/{robot}/tiles", Viewer, handle_of<&KeptRunsRoutes::tiles>(), "runs",
        "Several tiles of a layer of the run's picture.",
        "A line of JSON with the head of each tile, then their PNGs.", "application/octet-stream",
        "400 404 503", "kept_run kind robot tiles at low high from to"),
    get("/adit/runs/{key}/tracks", Viewer, handle_of<&KeptRunsRoutes::tracks>(), "runs",
        "The tracks of the robots in the run.", "The tracks.", "Tracks", "404 503", "kept_run"),
    get("/adit/runs/{key}/history", Viewer, handle_of<&KeptRunsRoutes::plots>(), "runs",
        "The plots of the run.", "The samples.", "History", "404 503", "kept_run"),
    get("/adit/runs/{key}/report.html", Viewer, handle_of<&KeptRunsRoutes::report>(), "runs",
        "The run's report to print: one file that loads no other files.", "The report.",
        "text/html; charset=utf-8", "404", "kept_run"),
    post("/adit/runs/{key}/delete", Operator, kJson<1024>, handle_of<&KeptRunsRoutes::remove>(), "Nothing",
         "runs", "Delete the run's map, tracks and plots, unless it is the present run. Its reports stay.",
         "They are deleted.", "KeptRunKey", "404 409", "kept_run"),
    get("/adit/log", Viewer, handle_of<&BoxRoutes::log>(), "box",
        "The last records of the log, oldest first: at most 2000.", "The records.", "Log", "400",
        "log_level log_text log_since"),
    get("/adit/log.txt", Viewer, handle_of<&BoxRoutes::log_text>(), "box", "The log as a file.",
        "A line for each record.", "text/plain; charset=utf-8", "400", "log_level log_text log_since"),
    get("/adit/about", Viewer, handle_of<&BoxRoutes::about>(), "box",
        "The box, its version and the parts of its program.", "About.", "About"),
    get("/adit/bundle", Operator, handle_of<&BoxRoutes::bundle>(), "box",
        "The support bundle for fault-finding, without tokens and passwords: a .tar.gz of at most 10 MB.",
        "The support bundle.", "application/gzip"),
    get("/adit/settings", Viewer, handle_of<&setup_view>(), "settings",
        "The settings in use, and what a form for them needs.", "The settings.", "Setup"),
    post("/adit/settings", Operator, kJson<262144>, handle_of<&settings_routes::save>(), "NewSettings",
         "settings", "Save and apply settings.", "The settings are saved, and about to be applied.",
         "Changes", "400 409 503"),
    post("/adit/settings/check", Operator, kJson<262144>, handle_of<&settings_routes::check>(),
         "SettingsToCheck", "settings",
         "Check settings: their errors, warnings and changes. This request changes no setting.",
         "The findings.", "Checked", "400"),
    get("/adit/settings/export", Viewer, handle_of<&settings_routes::export_settings>(), "settings",
        "The settings file, for a download.", "The file, without tokens.", "Settings"),
    get("/adit/network", Viewer, handle_of<&Network::state>(), "network",
        "The box's own addresses, and a change of them that is not yet confirmed.", "The addresses.",
        "Network"),
    post("/adit/network", Operator, kJson<4096>, handle_of<&network_routes::change>(), "Numbers", "network",
         "Change the addresses. The change is reverted unless it is confirmed in time.",
         "The change is being applied.", "Network", "409 503"),
    post("/adit/network/check", Operator, kJson<4096>, handle_of<&network_routes::check>(), "Numbers",
         "network", "Check addresses: their errors, warnings and changes. This request changes no setting.",
         "The findings.", "Checked"),
    post("/adit/network/confirm", Operator, kJson<4096>, handle_of<&network_routes::confirm>(), "Nothing",
         "network", "Confirm the change, by a request to the new address.", "The change is confirmed.",
         "Network", "409"),
    post("/adit/network/revert", Operator, kJson<4096>, handle_of<&Network::revert>(), "Nothing", "network",
         "Revert the change now.", "The change is being reverted.", "Network", "409"),
    get("/adit/update", Viewer, handle_of<&Updates::state>(), "box",
        "The running version, and the state of an update.", "The state.", "Update"),
    post("/adit/update", Operator, kBundle, handle_of<&update_routes::receive>(), "Bundle", "box",
         "Upload an update. The box checks it and installs it into the slot that is not running.",
         "The update is received, and is being checked.", "Update", "409 503", "again"),
    post("/adit/update/stick", Operator, kJson<1024>,
         handle_of<&Updates::install_from_stick, &read_again_flag>(), "FromStick", "box",
         "Install the update from the box's USB stick.", "The update is being checked.", "Update",
         "400 409 503"),
    post("/adit/update/restart", Operator, kJson<1024>, handle_of<&Updates::restart, &anyway_in>(), "Restart",
         "box", "Restart the box, to run the installed update.", "The box restarts.", "Update",
         "400 409 503"),
    post("/adit/update/back", Operator, kJson<1024>, handle_of<&Updates::restart_proven_slot, &anyway_in>(),
         "Restart", "box",
         "Restart the box into the expected slot, if an unexpected slot is running (`stray`).",
         "The box restarts.", "Update", "400 409 503"),
    post("/adit/update/stay", Operator, kJson<1024>, handle_of<&Updates::keep_running_slot>(), "Nothing",
         "box", "Keep the running slot, if it is not the expected one (`stray`).",
         "The slot is being recorded as the expected one.", "Update", "409 503"),
    get("/adit/certificate", Viewer, handle_of<&Certificate::state>(), "box",
        "Whether the box offers HTTPS, and its certificate's fingerprint.", "The certificate.",
        "Certificate"),
    post("/adit/certificate", Operator, kCertificate, handle_of<&certificate_routes::replace_certificate>(),
         "Certificate", "box",
         "Replace the certificate for HTTPS by an uploaded one, once the box has checked it.",
         "The certificate is in use; the TLS server restarts.", "Certificate", "409 503"),
    post("/adit/certificate/new", Operator, kJson<1024>, handle_of<&certificate_routes::make>(), "Nothing",
         "box", "Replace the certificate for HTTPS by a new one of the box's own.",
         "The certificate is in use; the TLS server restarts.", "Certificate", "409 503"),
    get("/adit/clock", Viewer, handle_of<&Clock::state>(), "box",
        "The time of day, and the source that set it.", "The clock.", "Clock"),
    post("/adit/clock", Operator, kJson<1024>, handle_of<&Clock::set_clock, &time_in>(), "ClockToSet", "box",
         "Set the time of day to the client's time.", "The time is about to be set.", "Clock", "400 409 503"),
    get("/adit/spare", Operator, handle_of<&Spare::state>(), "box",
        "Whether the box is on standby, the code of its export, and the export of another box.", "The state.",
        "Spare"),
    post("/adit/spare/standby", Operator, kJson<1024>, handle_of<&Spare::enter_standby>(), "Nothing", "box",
         "Put the box on standby, so that a spare can take over: it accepts and sends no messages, also "
         "after a power cut.",
         "Standby is about to begin.", "Spare", "409 503"),
    post("/adit/spare/resume", Operator, kJson<1024>, handle_of<&Spare::resume>(), "Nothing", "box",
         "End standby. Do this only if no spare took over.", "Standby is about to end.", "Spare", "409 503"),
    get("/adit/spare/export", Operator, handle_of<&spare_routes::send_export>(), "box",
        "The export for the spare: ledger, settings and tokens, sealed by a code. Only while the box is on "
        "standby.",
        "The export.", "application/octet-stream", "409 503"),
    post("/adit/spare/to-stick", Operator, kJson<1024>, handle_of<&spare_routes::export_to_stick>(),
         "Nothing", "box", "Write the export to the stick in the box. Only while the box is on standby.",
         "The export is about to be written.", "Spare", "409 503"),
    post("/adit/spare/from-stick", Operator, kJson<1024>, handle_of<&Spare::import_from_stick, &name_in>(),
         "ExportOnStick", "box",
         "Import another box's export from the stick in the box. The box does not change yet.",
         "The export is about to be read.", "Spare", "400 409 503"),
    post("/adit/spare/take", Operator, kExport, handle_of<&spare_routes::begin_import>(), "Export", "box",
         "Import another box's export. The box does not change yet.", "The export needs its code.", "Spare",
         "409"),
    post("/adit/spare/open", Operator, kJson<1024>, handle_of<&spare_routes::open>(), "ExportCode", "box",
         "Open the imported export, and show its content. The box does not change yet.",
         "The export is open.", "Spare", "400 409"),
    post("/adit/spare/forget", Operator, kJson<1024>, handle_of<&Spare::forget>(), "Nothing", "box",
         "Delete the imported export.", "The export is deleted.", "Spare", "409"),
    post("/adit/spare/take-over", Operator, kJson<1024>, handle_of<&spare_routes::take_over>(), "TakeOver",
         "box", "Take over from the box that made the export, with its reports, settings and tokens.",
         "The take-over is about to begin.", "Spare", "400 409 503"),
    get("/adit/test", Viewer, handle_of<&SelfTest::state>(), "network", "The Test, step by step.",
        "The steps.", "Test"),
    post("/adit/test", Operator, kJson<4096>, handle_of<&SelfTest::begin_test, &read_candidate>(),
         "Candidate", "network",
         "Start the Test of the endpoints in use or of named ones. It uses up no report; the run goes on.",
         "The Test has started.", "Test", "400 409"),
    post("/adit/tokens", Operator, kJson<262144>, handle_of<&settings_routes::set_token>(), "Token",
         "settings", "Save and apply a token, or remove it.",
         "The token is saved or removed, and the change is about to be applied.", "TokenSet", "400 409 503"),
    post("/adit/course", Operator, kJson<262144>, handle_of<&settings_routes::switch_course, &name_in>(),
         "Course", "settings", "Switch to a course's Command Post.", "The course is about to be applied.",
         "Changes", "400 409 503"),
    post("/adit/logout", Viewer, kJson<4096>, handle_of<&SessionRoutes::log_out>(), "Nothing", "login",
         "End the client's own session.", "The session is ended.", "LoggedOut"),
    post("/adit/reset", Operator, kJson<4096>, handle_of<&SessionRoutes::reset>(), "OwnPassword", "settings",
         "Factory reset. The reports stay.", "Settings, tokens, passwords and sessions are deleted.",
         "WasReset", "400 409 429 503"),
};

/// The parameters in `path` if it matches `pattern`.
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

/// "GET, HEAD, POST": reading methods first, as in the table.
void allow(std::string& methods, std::string_view method) {
  if (!methods.empty()) methods += ", ";
  methods += method == "GET" ? kReading : method;
}

}  // namespace

std::span<const Route> routes() {
  return kRoutes;
}

Match match(const intake::RequestHead& head) {
  Match match;
  if (is_read_only(head)) match.who = RouteAccess::Viewer;
  for (const Route& route : kRoutes) {
    auto parameters = parameters_in(route.path, head.path());
    if (!parameters) continue;
    allow(match.allowed, route.method);
    const bool fits = route.method == "GET" ? is_read_only(head) : route.method == head.method();
    if (fits) return {&route, std::move(*parameters), {}, route.who};
    if (route.who < RouteAccess::OperatorOrSetUp) match.who = route.who;  // its clients may learn its methods
  }
  return match;
}

}  // namespace adit::api
