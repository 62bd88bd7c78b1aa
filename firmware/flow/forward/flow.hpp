#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "api/source.hpp"
#include "archive/archive.hpp"
#include "dispatch/reports.hpp"
#include "forward/clocks.hpp"
#include "forward/delivered_scene.hpp"
#include "forward/map_picture.hpp"
#include "forward/maps.hpp"
#include "forward/rejected.hpp"
#include "forward/scoring.hpp"
#include "forward/telemetry.hpp"
#include "forward/traffic_counts.hpp"
#include "icd/bearer_token.hpp"
#include "intake/message_handler.hpp"
#include "journal/journal.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "settings/settings.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// Sending rate of the last seconds.
class Meter {
 public:
  static constexpr std::size_t kSeconds = 5;

  /// Call once a second with the total of sent bytes.
  void on_second(std::uint64_t bytes) {
    bytes_.push_back(bytes);
    if (bytes_.size() > kSeconds + 1) bytes_.pop_front();
  }
  double mbit() const {
    if (bytes_.size() < 2) return 0;
    const auto bytes = static_cast<double>(bytes_.back() - bytes_.front());
    return bytes * 8 / 1e6 / static_cast<double>(bytes_.size() - 1);
  }

 private:
  std::deque<std::uint64_t> bytes_;  // totals of the last seconds
};

/// A flow's end: waits for requests in flight and for storing, each for a limited time, then dismisses
/// clients and lets their answers leave.
class Ending {
 public:
  static constexpr std::chrono::milliseconds kAnswers{800};      // for requests in flight
  static constexpr std::chrono::milliseconds kKeepWithin{3000};  // for messages that are being stored
  static constexpr std::chrono::milliseconds kStep{10};
  static constexpr std::chrono::milliseconds kFlush{50};  // for the last answers

  void begin(loop::Instant now) { began_ = now; }
  bool has_begun() const { return began_.has_value(); }
  /// True if clients are to be dismissed now. `quiet`: no request in flight; `kept`: all is stored. Requires
  /// has_begun().
  bool dismisses(loop::Instant now, bool quiet, bool kept);
  /// True after the dismissal, or if storing fails for too long. Requires has_begun().
  bool is_over(loop::Instant now) const;

 private:
  std::optional<loop::Instant> began_;
  bool dismissed_ = false;  // only answers are still to leave
};

/// Lets the ledger prepare room in the background.
class LedgerUpkeep {
 public:
  /// Delay after a start or a failure. The first messages have priority.
  static constexpr std::chrono::seconds kEvery{60};

  /// Both outlive this.
  LedgerUpkeep(loop::Loop& loop, ledger::Ledger& ledger) : loop_(loop), ledger_(ledger) {}

  /// Call once a second. `disk` does the work. A failure is logged once.
  void tick(loop::Writer& disk);

 private:
  void on_done(const ledger::Result<void>& result);

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  loop::Instant at_ = loop_.now() + kEvery;
  std::string trouble_;  // why it failed, or ""
};

/// Notices that the present run is another one, or that the Command Post may have another map.
class RunNews {
 public:
  enum class Change : std::uint8_t {
    None,
    FirstLook,
    LikelyAnother,  // the last status tells of another run, which is not yet certain
    Another,        // next_map() says what the Command Post has of the map
  };

  /// `settings` outlives this.
  explicit RunNews(const settings::Settings& settings) : settings_(settings) {}

  /// The change since the last look.
  Change update(const dispatch::Reports& reports);
  dispatch::NextMap next_map() const { return next_map_; }

 private:
  dispatch::NextMap next_map_after(std::int64_t before, const dispatch::Reports& reports) const;
  bool is_by_settings(const dispatch::Run& run) const;
  bool update_clock(const dispatch::Run& run);

  const settings::Settings& settings_;
  std::int64_t run_ = 0;    // at the last look; 0: none yet
  double clock_shown_ = 0;  // clock of the last status at the last look
  dispatch::NextMap next_map_ = dispatch::NextMap::MayBeTheSame;
};

/// The present time of day by other clocks, in seconds since 1970.
struct KnownTimes {
  std::optional<double> command_post, robots;
};

/// `all`: every token, which sentences must not quote.
struct Tokens {
  std::optional<icd::BearerToken> scoring, mapping;
  std::vector<icd::BearerToken> all;

  /// A sentence may quote a client's token from a wrong field.
  std::string strike_from(std::string sentence) const;
};

/// The team's messages from intake (as its MessageHandler) to uplink, sent by Scoring, Maps and Telemetry.
class Flow final : public intake::MessageHandler, public api::Operator {
 public:
  /// Directories of messages, below the runtime directory.
  static constexpr const char *kJournal = "/journal", *kWaiting = "/waiting", *kRejected = "/rejected";
  struct Folders {
    std::string runtime, state;
  };
  /// Callbacks, called on the loop.
  struct Callbacks {
    std::function<void()> on_changed;                        // the page's contents changed
    std::function<void(const std::string& name)> on_posted;  // a robot posted
  };

  /// `settings`: with the course in use. All references outlive this.
  Flow(loop::Loop& loop, ledger::Ledger& ledger, const settings::Settings& settings, Tokens tokens,
       const Folders& folders, Callbacks callbacks);

  /// Continues the work of the previous process, and connects.
  void start();
  /// Which queued or rejected messages of the previous process are missing, because they are damaged or
  /// cannot be read, or processes ended while they worked on them; or "".
  std::string put_aside() const;
  /// Why a file that sending needs is unreadable, or "".
  std::string unread() const { return clocks_.unread(); }
  /// After start(): all files of messages were read.
  bool has_read_messages() const {
    return journal_.unread().empty() && spool_.unread().empty() && rejected_.unread().empty();
  }
  /// All files of messages can be read now.
  static bool can_be_read(const std::string& runtime_folder);
  /// Before start(): accepts and sends no message. Clients get the sentence `why`.
  void set_standby(const std::string& why);
  /// `restarts`: endpoints with a new address, way or token. Clients keep waiting.
  void on_settings_changed(const settings::Restarts& restarts, Tokens tokens);
  /// Once a second. `disk`: for small files of the state directory.
  void tick(loop::Writer& disk);
  KnownTimes known_times() const;
  const Clocks& clocks() const { return clocks_; }
  void set_known_time(double time) { clocks_.set_known_time(time); }
  /// The time of day was set ahead by `seconds`.
  void on_wall_set(double seconds);
  /// The cable is in again: retries at once.
  void on_link_up();
  /// Stops sending, waits for answers in flight, stores messages, and calls `over`.
  void end(std::function<void()> over);
  bool is_ending() const { return ending_.has_begun(); }

  std::shared_ptr<intake::MapArrival> begin_map() override;
  icd::Checked<void> accept(icd::StateUpdate update, const intake::Sender& sender) override;
  void accept(icd::MarkersUpdate update, const intake::Sender& sender, MarkerArrivals::Done done) override;
  void accept(const icd::ArtifactReport& report, const intake::Sender& sender,
              std::shared_ptr<intake::Responder> responder) override;
  void status(const intake::Sender& sender, std::shared_ptr<intake::Responder> responder) override;
  void record_dropped(icd::Uri uri, const intake::Sender& sender, const std::string& why) override;
  void on_rejected(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& callbacks) override;

  /// When the operator's test may send, as a turn of the pace of `uri`. nullopt: not before `latest`.
  std::optional<loop::Instant> claim(icd::Uri uri, loop::Instant latest) {
    return pace_of(uri).claim(loop_.now(), latest);
  }
  void on_claimed(icd::Uri uri) { pace_of(uri).on_claimed(loop_.now()); }

  std::expected<std::int64_t, std::string> decide(std::int64_t number, api::Action action) override {
    if (!standby_.empty()) return std::unexpected(standby_);
    return scoring_.decide(number, action);
  }
  std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report, bool resubmit) override {
    if (!standby_.empty()) return std::unexpected(standby_);
    return scoring_.report(report, resubmit);
  }
  std::expected<std::int64_t, std::string> correct(std::int64_t number,
                                                   const icd::ArtifactReport& to) override {
    if (!standby_.empty()) return std::unexpected(standby_);
    return scoring_.correct(number, to);
  }
  std::expected<void, std::string> change_rejected(std::uint64_t number, api::RejectedAction action) override;
  std::int64_t begin_run() override { return scoring_.begin_run(); }

  const Scoring& scoring() const { return scoring_; }
  const dispatch::Reports& reports() const { return scoring_.reports(); }
  const Maps& maps() const { return maps_; }
  const Telemetry& telemetry() const { return telemetry_; }
  /// The last messages before a restart, by robot.
  const std::map<std::string, journal::Heard>& heard_before() const { return heard_before_; }
  /// Stores `heard` for the next process.
  void keep(const journal::Heard& heard) { journal_.record_heard(heard); }
  const RejectedStore& rejected_store() const { return rejected_; }
  const TrafficCounts& counts() const { return counts_; }
  const DeliveredScene& delivered_scene() const { return delivered_; }
  const picture::Mosaic& picture() const { return picture_.mosaic(); }
  api::FineMap& fine_map() { return picture_.fine_map(); }
  api::CoveredMap& covered_map() { return picture_.covered_map(); }
  archive::Archive& archive() { return archive_; }
  const archive::Archive& archive() const { return archive_; }
  /// The record's rows with the queued messages.
  std::vector<facts::ActivityRow> activities() const;
  /// Why states and markers cannot be stored, or "".
  const std::string& journal_trouble() const { return journal_.trouble(); }
  std::uint64_t sent_bytes() const;
  double sent_mbit() const { return meter_.mbit(); }

  /// For long work. They end before the other members.
  loop::Workers& workers() { return workers_; }
  /// For the watchdog.
  std::vector<loop::Workers*> threads() { return {&workers_, &writer_, &archive_.thread()}; }

 private:
  UriPace& pace_of(icd::Uri uri) {
    return icd::endpoint_of(uri) == icd::Endpoint::Scoring ? scoring_.status_pace() : telemetry_.state_pace();
  }
  void restore_handover(double newest);
  void restore(bool is_first);
  void accept(icd::MapUpdate update, const intake::Sender& sender, std::shared_ptr<spool::MapFile> file,
              std::function<void(icd::Checked<void>)> done);
  void on_changed();
  void update_picture();
  void restore_run();
  archive::RunSnapshot archive_view() const;
  void drain();

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  LedgerUpkeep upkeep_;
  const settings::Settings& settings_;
  Tokens tokens_;
  Callbacks callbacks_;
  std::mt19937_64 random_;
  spool::Spool spool_;     // before its writer, whose jobs use it to the end
  loop::Writer writer_;    // of the runtime directory: answers to maps wait for it
  loop::Workers workers_;  // after the writer: jobs hold its objects
  journal::Journal journal_;
  Clocks clocks_;
  std::map<std::string, journal::Heard> heard_before_;
  RejectedStore rejected_;
  TrafficCounts counts_;
  uplink::Servers servers_;
  Scoring scoring_;
  RunNews run_news_;
  MapPicture picture_;
  Maps maps_;
  DeliveredScene delivered_;
  Telemetry telemetry_;
  Meter meter_;
  std::string standby_;       // why the flow stands by, or ""
  bool has_started_ = false;  // before that the run is unknown
  archive::Archive archive_;
  Ending ending_;
  std::function<void()> over_;
  loop::Source drained_;
};

}  // namespace adit::forward
