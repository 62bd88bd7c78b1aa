#pragma once

#include <deque>
#include <expected>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "forward/as_forwarded.hpp"
#include "forward/aside.hpp"
#include "forward/map_picture.hpp"
#include "forward/maps.hpp"
#include "forward/news.hpp"
#include "forward/record.hpp"
#include "forward/scoring.hpp"
#include "forward/stamp_floor.hpp"
#include "gateway/accounts.hpp"
#include "gateway/button_watch.hpp"
#include "gateway/ledger_return.hpp"
#include "gateway/lights.hpp"
#include "gateway/links.hpp"
#include "gateway/listen_sockets.hpp"
#include "gateway/network_change.hpp"
#include "gateway/network_requests.hpp"
#include "gateway/roster.hpp"
#include "gateway/self_test.hpp"
#include "gateway/session_keeper.hpp"
#include "gateway/setup.hpp"
#include "gateway/store.hpp"
#include "gateway/this_box.hpp"
#include "gateway/updates.hpp"
#include "host/service.hpp"
#include "intake/icd_routes.hpp"
#include "journal/journal.hpp"
#include "lanes/stamps.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "page/page.hpp"
#include "panel/lines.hpp"
#include "settings/board.hpp"
#include "settings/settings.hpp"
#include "spool/spool.hpp"

namespace adit::gateway {

/// What one gateway hands on to the next that takes its place.
struct Legacy {
  picture::Mosaic picture;
  std::int64_t pictured_run = 0;  // whose maps it shows; 0: none yet
  forward::AsForwarded as_forwarded;
};

/// What the gateway is made of: all of it has passed its checks.
struct Parts {
  const Store& store;         // outlives the gateway
  const FactoryReset& reset;  // so does this
  ListenSockets& sockets;     // and this
  Store::Loaded loaded;
  std::string trouble;  // for the operator: why the settings are not those that were wanted; or ""
  ledger::Ledger ledger;
  std::chrono::seconds ledger_rest;  // before it is looked whether one that takes no write does again
  settings::Board board;
  std::string board_trouble;         // why what the board's file says does not count; or ""
  std::vector<std::string> notices;  // of those who started the box
  std::unique_ptr<panel::Lines> lines;
  std::unique_ptr<panel::ButtonLine> button;  // null: there is none
  std::string runtime_folder;
  std::string state_folder;
  std::string update_folder;     // where adit-update tells its status
  std::string network_folder;    // where adit-network tells its status
  std::optional<Legacy> legacy;  // of the gateway before, where there was one
};

/// The whole of Adit at work: the team's messages come in by Desk and leave by Scoring, Maps and News.
class Gateway final : public intake::Desk, public page::Source, public page::Operator {
 public:
  static constexpr std::chrono::milliseconds kDrain{800};  // how long stop() waits for answers under way
  static constexpr std::chrono::milliseconds kKeepWithin{3000};  // and for what is being kept

  Gateway(loop::Loop& loop, Parts parts);
  ~Gateway() override;

  /// Listens and connects. An error says what could not be done.
  std::expected<void, std::string> start();
  /// Takes nothing new, waits for the answers under way, keeps what waits, and stops the loop.
  void stop();
  /// Whether it stopped so that another, of what the store holds by now, takes its place.
  bool makes_way() const { return makes_way_; }
  /// Once it has stopped, or could not start.
  Legacy hand_over() { return {picture_.hand_over(), pictured_run_, std::move(as_forwarded_)}; }
  /// All its threads, to be asked for signs of life.
  std::vector<loop::Workers*> threads() { return {&workers_, &log_ins_, &writer_, &disk_writer_}; }
  /// What systemd shows: one line.
  std::string status_line() const;

  std::shared_ptr<intake::MapArrival> map_arrives() override;
  icd::Checked<void> take(const icd::StateUpdate& update, const intake::Sender& sender) override;
  icd::Checked<void> take(const icd::MarkersUpdate& update, const intake::Sender& sender) override;
  void take(const icd::ArtifactReport& report, const intake::Sender& sender,
            std::shared_ptr<intake::Responder> responder) override;
  void status(const intake::Sender& sender, std::shared_ptr<intake::Responder> responder) override;
  void refused(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& told) override;

  page::RunView view() const override;
  std::vector<page::ReportRow> reports() const override;
  std::optional<page::ReportDetail> report(std::int64_t number) const override;
  std::expected<std::int64_t, std::string> judge(std::int64_t number, page::Deed deed) override;
  std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report, bool resubmit) override;
  std::expected<void, std::string> aside(std::uint64_t number, page::AsideDeed deed) override;
  std::int64_t begin_run() override;
  page::Time identify(double seconds) override;
  const picture::Mosaic& map() const override { return picture_.mosaic(); }
  page::MarkerNews markers(std::uint64_t since) const override { return as_forwarded_.markers().news(since); }
  std::vector<page::Track> tracks(page::Time since) const override {
    return as_forwarded_.tracks().since(since);
  }

 private:
  void take(icd::MapUpdate update, const intake::Sender& sender, std::shared_ptr<spool::MapFile> file,
            std::function<void(icd::Checked<void>)> done);
  void hold_back();
  void link_is_back();
  void make_way();
  void end();
  void carry_on();
  void restore(bool is_first);
  icd::Stamp stamped_here(const std::string& clock, std::optional<icd::Stamp> stamp,
                          std::uint64_t connection);
  void keep_clock(const std::string& clock);
  void drain();
  void finish();
  void changed();
  void picture_the_run();
  void every_second();
  void keep_sessions();
  void keep_stamp_floor();
  void look_at_sockets();
  void ledger_is_back();
  void show_lights();
  double sent_mbit() const;
  std::uint64_t sent_bytes() const;
  void add_to(page::Usage& usage) const;
  std::expected<void, std::string> listen();
  intake::IcdOptions icd_options() const;
  std::vector<icd::BearerToken> tokens() const;
  void note_robot(const std::string& name);
  void assert_states();
  void pressed(panel::Press press);
  void show_address();
  std::string team_address() const;
  std::vector<std::string> attention() const;
  std::string report_under_way() const;
  void say_what_is_set_aside(std::vector<std::string>& sentences) const;
  void say_what_is_missing(std::vector<std::string>& sentences) const;
  std::vector<page::EndpointRow> endpoints() const;

  loop::Loop& loop_;
  Parts parts_;
  const settings::Settings settings_;  // with the course in use
  std::mt19937_64 random_;
  spool::Spool spool_;  // before its writer, whose jobs use it to the end
  forward::StampFloor stamp_floor_;
  loop::Writer writer_;       // of the runtime folder, in memory: an answer to a map waits for it
  loop::Writer disk_writer_;  // of the state folder, on the disk, for which no map waits
  loop::Workers workers_;     // after the writers: what a job holds is the writers' to the end
  loop::Workers log_ins_;     // of their own: nobody who logs in waits behind maps, nor maps behind him
  journal::Journal journal_;
  forward::Aside aside_;
  forward::Record record_;
  lanes::StampShift stamps_;
  forward::Scoring scoring_;
  forward::MapPicture picture_;
  forward::Maps maps_;
  forward::AsForwarded as_forwarded_;
  forward::News news_;
  Lights lights_;
  Links links_;
  ButtonWatch button_;
  Roster roster_;
  SessionKeeper sessions_;
  Accounts accounts_;
  NetworkRequests network_requests_;
  Setup setup_;
  ThisBox box_;
  NetworkChange network_;
  SelfTest self_test_;
  Updates updates_;
  page::Page page_;
  intake::IcdRoutes routes_;
  std::vector<std::unique_ptr<intake::Server>> servers_;
  loop::Source second_, drained_;
  loop::Instant sessions_kept_{};
  std::optional<LedgerReturn> ledger_return_;
  std::int64_t pictured_run_;             // Legacy's
  std::deque<std::uint64_t> bytes_sent_;  // in all, at each of the last seconds
  bool makes_way_ = false;
  bool dismissed_ = false;  // all clients have been told; only their answers have to leave
  std::string notified_;
  panel::Lights told_lights_{};  // what pages were told that the lights show
  std::optional<loop::Instant> stop_by_;
};

}  // namespace adit::gateway
