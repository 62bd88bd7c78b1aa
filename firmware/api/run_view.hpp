#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/scene.hpp"
#include "icd/geometry.hpp"
#include "icd/run_status.hpp"

namespace adit::api {

/// One artifact report and where it is in its life.
struct ReportRow {
  std::int64_t number = 0;
  std::string type;
  icd::Point position;  // nothing where it is lost
  std::string sender;
  Time received = 0, changed = 0;
  std::string state;  // dispatch::name_of(ReportState): "received", "waiting", "in doubt", "settled", ...
  int status = 0;     // the Command Post's; 0: none yet
  std::string report_status;
  std::optional<std::int64_t> score_change;
  std::string note;
  std::int64_t run = 1;      // dispatch::Run::number of the run that it belongs to
  bool asking = false;       // in doubt, and Adit is finding out
  bool reconciled = false;   // its answer was found out from the run's status
  std::int64_t same_as = 0;  // the earlier report that it turned out to be; 0: none
  bool lost = false;         // damage took from the ledger what it said: dispatch::Report::is_lost
};

/// One step of a report's life.
struct ReportStep {
  Time at = 0;
  std::string state, note;
};

struct ReportDetail {
  ReportRow row;
  std::vector<ReportStep> history;  // oldest first
  std::string answer;               // the stored answer's body, byte for byte
};

/// One robot's (or, with no name, the merged) traffic of one kind.
struct ActivityRow {
  std::string kind;   // "grid", "cloud", "state", "markers"
  std::string robot;  // "" for merged maps and for markers
  std::uint64_t accepted = 0, forwarded = 0, replaced = 0, merged = 0, throttled = 0, failed = 0,
                refused_upstream = 0;
  std::uint64_t waiting = 0;
  std::optional<Time> last_accepted, last_forwarded;
  std::size_t bytes_received = 0, bytes_sent = 0;  // of the last of each
  int last_status = 0;                             // the Command Post's, to the last try; 0: none came
  std::string last_sentence;                       // what it said, or why nothing came
};

/// What was refused to its sender.
struct RefusalRow {
  Time at = 0;
  std::string uri, sender;
  int status = 0;
  std::string sentence;
  std::uint64_t parts = 0;  // of a state or of markers, that were refused; 0: it was refused as a whole
};

struct EndpointRow {
  std::string name;     // "scoring", "mapping"
  std::string address;  // "10.100.1.200:8000"
  bool connected = false;
  std::string trouble;  // "" where there is none
  int last_status = 0;
  std::optional<double> answer_ms;  // of the last request
  std::uint64_t throttled = 0;      // answers of 429, ever
  std::uint64_t foreign = 0;        // answers that no Command Post gives, ever: pages of HTML, redirects
};

/// A map, state or markers that the Command Post would not take: kept until it is sent again or discarded.
struct AsideRow {
  std::uint64_t number = 0;
  std::string kind;   // "grid", "cloud", "state", "markers"
  std::string robot;  // "": of several, or of none
  Time at = 0;        // when it was set aside
  int status = 0;     // the Command Post's
  std::string why;    // its sentence
  std::size_t bytes = 0;
  bool overtaken = false;  // something newer that says all of it was sent since: it is not sent again
};

/// A robot as the Command Post knows it.
struct RobotRow {
  std::string name;
  icd::Point position;  // of its last forwarded pose, in the frame "darpa"
  double heading = 0;   // radians about z: 0 along x, left is more
  Time at = 0;          // when that was forwarded
};

struct LightRow {
  std::string name, pattern;  // panel::name_of
};

/// One of the two cables.
struct LinkRow {
  std::string side, interface;  // "team" or "command_post"
  std::optional<bool> carrier;  // nothing: there is no such interface
};

/// All that the page, `adit status` and tests read.
struct RunView {
  Time now = 0;
  std::string version;
  std::optional<icd::RunStatus> run;  // as last heard
  std::optional<Time> run_heard;
  std::int64_t run_number = 1;  // dispatch::Run
  std::string run_id;           // the Command Post's; "": it names none
  std::vector<EndpointRow> endpoints;
  std::vector<RobotRow> robots;    // by name
  std::vector<ReportRow> reports;  // newest first: all that are not done, and the newest others
  double near_metres = 0;          // of one type and this near, two reports may be of one artifact
  std::vector<ActivityRow> activities;
  std::vector<RefusalRow> refusals;  // newest first, the last 50
  std::vector<AsideRow> aside;       // oldest first
  std::vector<LightRow> lights;
  std::vector<LinkRow> links;            // of the interfaces that the settings name
  std::optional<Time> identify_until;    // the lights blink so that the box can be found
  std::optional<Time> setup_open_until;  // the button opened set-up: Keys::set_up_open()
  double budget_mbit = 0;
  double sent_mbit = 0;  // over the last seconds, to both endpoints
  std::size_t queued_bytes = 0;
  std::uint64_t map_version = 0;       // picture::Mosaic::version(): says whether /adit/map has changed
  std::uint64_t marker_version = 0;    // the same for /adit/markers
  std::vector<std::string> attention;  // sentences for the operator, most urgent first
};

/// The JSON of /adit/run; each member is named as in RunView, absent optionals are null.
std::string write_run_view(const RunView& view);

}  // namespace adit::api
