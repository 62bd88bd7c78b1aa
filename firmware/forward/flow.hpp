#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "api/source.hpp"
#include "archive/archive.hpp"
#include "forward/as_forwarded.hpp"
#include "forward/clocks.hpp"
#include "forward/ending.hpp"
#include "forward/map_picture.hpp"
#include "forward/maps.hpp"
#include "forward/meter.hpp"
#include "forward/record.hpp"
#include "forward/rejected.hpp"
#include "forward/scoring.hpp"
#include "forward/telemetry.hpp"
#include "icd/bearer_token.hpp"
#include "intake/desk.hpp"
#include "journal/journal.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "settings/restarts.hpp"
#include "settings/settings.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// What the flow hears of the time of day, in seconds since 1970, now.
struct KnownTimes {
  std::optional<double> command_post, robots;
};

/// The flow's tokens, and all tokens that there are: no sentence may quote one.
struct Tokens {
  std::optional<icd::BearerToken> scoring, mapping;
  std::vector<icd::BearerToken> all;
};

/// The way of the team's messages from intake to uplink: this is the Desk that takes them, and Scoring, Maps
/// and Telemetry send them.
class Flow final : public intake::Desk {
 public:
  /// Upkeep of the ledger begins so long after the start, because the first messages have priority, and
  /// again so long after a failure.
  static constexpr std::chrono::seconds kUpkeepEvery{60};
  /// Directories of messages below the runtime folder.
  static constexpr const char *kJournal = "/journal", *kWaiting = "/waiting", *kRejected = "/rejected";
  struct Folders {
    std::string runtime, state;
  };
  /// Who is told what. Each is called on the loop.
  struct Told {
    std::function<void()> changed;                        // what the page shows
    std::function<void(const std::string& name)> posted;  // a robot posts
  };

  /// `settings`: with the course in use. All references outlive this.
  Flow(loop::Loop& loop, ledger::Ledger& ledger, const settings::Settings& settings, Tokens tokens,
       const Folders& folders, Told told);

  /// Goes on where the life before ended, and connects.
  void start();
  /// Which queued maps were put aside, and why; or "".
  const std::string& put_aside() const { return spool_.ended_processes(); }
  /// Why a file without which nothing may be sent cannot be read, as a sentence; or "".
  std::string unread() const { return clocks_.unread(); }
  /// After start(): whether the files of all messages of the process before were read.
  bool has_read_messages() const {
    return journal_.unread().empty() && spool_.unread().empty() && rejected_.unread().empty();
  }
  /// Whether the files of all messages below the runtime folder can be read now.
  static bool can_be_read(const std::string& runtime_folder);
  /// Before start(): shows what there is, and takes nothing and sends nothing. `why`: a sentence for who
  /// asks.
  void stand_by(const std::string& why);
  /// The settings have changed; `restarts` names the endpoints that have another address, way or token.
  /// Clients that wait go on waiting.
  void settings_changed(const settings::Restarts& restarts, Tokens tokens);
  /// Once a second. `disk`: the writer of small files of the state folder.
  void tick(loop::Writer& disk);
  KnownTimes known_times() const;
  /// Somebody set the time of day ahead by so many seconds.
  void wall_was_set(double seconds);
  /// The Command Post's cable is in again: what would wait because sending failed without it need not wait.
  void link_is_back();
  /// Takes nothing new, waits for the answers under way, keeps what waits, and then calls `over`.
  void end(std::function<void()> over);
  bool is_ending() const { return ending_.has_begun(); }

  std::shared_ptr<intake::MapArrival> map_arrives() override;
  icd::Checked<void> take(icd::StateUpdate update, const intake::Sender& sender) override;
  void take(icd::MarkersUpdate update, const intake::Sender& sender, MarkerArrivals::Done done) override;
  void take(const icd::ArtifactReport& report, const intake::Sender& sender,
            std::shared_ptr<intake::Responder> responder) override;
  void status(const intake::Sender& sender, std::shared_ptr<intake::Responder> responder) override;
  void left_out(icd::Uri uri, const intake::Sender& sender, const std::string& why) override;
  void refused(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& told) override;

  /// When the operator's test may ask an endpoint that the run uses for its status, or send it a state: a
  /// turn of the run's own, so that neither is throttled. Nothing: not before `latest`.
  std::optional<loop::Instant> claim(icd::Uri uri, loop::Instant latest) {
    return pace_of(uri).claim(loop_.now(), latest);
  }
  void claimed(icd::Uri uri) { pace_of(uri).claimed(loop_.now()); }

  /// The operator's actions: api::Operator.
  std::expected<std::int64_t, std::string> judge(std::int64_t number, api::Action action) {
    if (!standby_.empty()) return std::unexpected(standby_);
    return scoring_.judge(number, action);
  }
  std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report, bool resubmit) {
    if (!standby_.empty()) return std::unexpected(standby_);
    return scoring_.report(report, resubmit);
  }
  std::expected<void, std::string> rejected(std::uint64_t number, api::RejectedAction action);
  std::int64_t begin_run() { return scoring_.begin_run(); }

  const Scoring& scoring() const { return scoring_; }
  const dispatch::Reports& reports() const { return scoring_.reports(); }
  const Maps& maps() const { return maps_; }
  const Telemetry& telemetry() const { return telemetry_; }
  /// When robots were heard before a restart, by robot.
  const std::map<std::string, journal::Heard>& heard_before() const { return heard_before_; }
  /// For the next process start.
  void keep(const journal::Heard& heard) { journal_.heard(heard); }
  const RejectedStore& rejected() const { return rejected_; }
  const Record& record() const { return record_; }
  const AsForwarded& as_forwarded() const { return as_forwarded_; }
  const picture::Mosaic& picture() const { return picture_.mosaic(); }
  api::FinerMap& finer() { return picture_.finer(); }
  /// What is kept of runs.
  archive::Archive& archive() { return archive_; }
  const archive::Archive& archive() const { return archive_; }
  /// Record's, with what waits.
  std::vector<api::ActivityRow> activities() const;
  /// Why states and markers cannot be kept, or "".
  const std::string& journal_trouble() const { return journal_.trouble(); }
  std::uint64_t sent_bytes() const;
  double sent_mbit() const { return meter_.mbit(); }

  /// For work that takes long; they end before anything that the flow holds.
  loop::Workers& workers() { return workers_; }
  /// All its threads, to be asked for signs of life.
  std::vector<loop::Workers*> threads() { return {&workers_, &writer_, &archive_.thread()}; }

 private:
  UriPace& pace_of(icd::Uri uri) {
    return uri == icd::Uri::Status ? scoring_.status_pace() : telemetry_.state_pace();
  }
  std::optional<api::Time> behind_since(const Traffic& traffic) const;
  void carry_on();
  void keep_ledger(loop::Writer& disk);
  void restore(bool is_first);
  void restore_record();
  void take(icd::MapUpdate update, const intake::Sender& sender, std::shared_ptr<spool::MapFile> file,
            std::function<void(icd::Checked<void>)> done);
  void changed();
  void picture_the_run();
  dispatch::NextMap next_map(std::int64_t before, const dispatch::Run& run) const;
  bool is_by_settings(const dispatch::Run& run) const;
  bool status_came();
  void keep_the_run();
  archive::Seen seen() const;
  archive::Sample sample() const;
  api::RunRow facts() const;
  void drain();
  std::string without_tokens(std::string sentence) const;

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  loop::Instant upkeep_at_ = loop_.now() + kUpkeepEvery;  // of the ledger
  std::string upkeep_trouble_;                            // why the last one failed, or ""
  const settings::Settings& settings_;
  Tokens tokens_;
  Told told_;
  std::mt19937_64 random_;
  spool::Spool spool_;     // before its writer, whose jobs use it to the end
  loop::Writer writer_;    // of the runtime folder, in memory: an answer to a map waits for it
  loop::Workers workers_;  // after the writer: what a job holds is the writer's to the end
  journal::Journal journal_;
  Clocks clocks_;
  std::map<std::string, journal::Heard> heard_before_;
  RejectedStore rejected_;
  Record record_;
  Scoring scoring_;
  MapPicture picture_;
  Maps maps_;
  AsForwarded as_forwarded_;
  Telemetry telemetry_;
  Meter meter_;
  std::int64_t pictured_run_ = 0;  // whose maps the picture shows; 0: none yet
  double clock_shown_ = 0;         // by the last status of it
  std::string standby_;            // why nothing is taken and sent; "": it is
  bool has_started_ = false;       // until then the ledger has not said which run it is
  archive::Archive archive_;
  Ending ending_;
  std::function<void()> over_;
  loop::Source drained_;
};

}  // namespace adit::forward
