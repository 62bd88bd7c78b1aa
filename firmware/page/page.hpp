#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "icd/artifact_report.hpp"
#include "icd/bearer_token.hpp"
#include "icd/geometry.hpp"
#include "icd/run_status.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"
#include "page/scene.hpp"
#include "picture/mosaic.hpp"

namespace adit::page {

class Box;
class Keys;
class Network;
class SelfTest;
class Setup;
class Updates;

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

/// Where the page gets what it shows.
class Source {
 public:
  virtual ~Source() = default;
  virtual RunView view() const = 0;
  virtual std::vector<ReportRow> reports() const = 0;  // of all runs, oldest first
  virtual std::optional<ReportDetail> report(std::int64_t number) const = 0;
  virtual const picture::Mosaic& map() const = 0;
  /// What changed after version `since`.
  virtual MarkerNews markers(std::uint64_t since) const = 0;
  /// Where each robot was in this run after `since`.
  virtual std::vector<Track> tracks(Time since) const = 0;
};

/// The operator's word on a report: see dispatch::Reports.
enum class Deed : std::uint8_t { Send, Hold, Withdraw, CallDone, Resubmit };

/// The operator's word on a message that was set aside.
enum class AsideDeed : std::uint8_t { Send, Discard };

/// What does as the operator says.
class Operator {
 public:
  virtual ~Operator() = default;
  /// Gives the number of the report that it moved, or a sentence why not.
  virtual std::expected<std::int64_t, std::string> judge(std::int64_t number, Deed deed) = 0;
  /// Takes a report that the operator composed, like one that a client posts; the number it has, or that the
  /// same one has already. A sentence: it was not taken.
  virtual std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report,
                                                          bool resubmit) = 0;
  /// A sentence: why not.
  virtual std::expected<void, std::string> aside(std::uint64_t number, AsideDeed deed) = 0;
  /// Gives the new run's number.
  virtual std::int64_t begin_run() = 0;
  /// All lights blink for so long. Gives until when.
  virtual Time identify(double seconds) = 0;
};

/// The local web page, on the team's side, and the operator's word on reports, behind a login: README.md has
/// its routes, firmware/access/README.md says what protects them.
///
/// Every answer but the events carries a Content-Security-Policy of `default-src 'none'` with what the page
/// needs, X-Content-Type-Options and Referrer-Policy; every error is a JSON string.
class Page final : public intake::Handler {
 public:
  static constexpr int kEventsPerSecond = 4;

  /// `tokens`: any of them lets a script in as an operator; empty: none does. All others outlive this, and
  /// whatever `keys` still answers.
  Page(loop::Loop& loop, const Source& source, Operator& judge, Keys& keys,
       std::vector<icd::BearerToken> tokens);
  ~Page() override;

  /// Serves the settings, too; `setup` outlives this. Once, before anything is opened.
  void serve(Setup& setup);

  std::unique_ptr<intake::Exchange> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder,
                                         std::shared_ptr<intake::Flow> flow) override;

  /// Serves the box's own addresses and the Test, too; they outlive this. Once, before anything is opened.
  void serve(Network& network, SelfTest& test);

  /// Serves the update of the box, too; it outlives this. Once, before anything is opened.
  void serve(Updates& updates);

  /// Serves what is known of the box, too; it outlives this. Once, before anything is opened.
  void serve(Box& box);

  /// These tokens let a script in from now on.
  void let_in(std::vector<icd::BearerToken> tokens);

  /// Something that the page shows has changed.
  void changed();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::page
