#pragma once

#include <expected>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "admin/accounts.hpp"
#include "admin/acknowledged_file.hpp"
#include "admin/clock_setting.hpp"
#include "admin/network_change.hpp"
#include "admin/session_keeper.hpp"
#include "admin/setup.hpp"
#include "admin/spare.hpp"
#include "admin/store.hpp"
#include "admin/taking_over.hpp"
#include "admin/updates.hpp"
#include "alarms/board.hpp"
#include "alarms/facts.hpp"
#include "api/api.hpp"
#include "box/button_watch.hpp"
#include "box/lights.hpp"
#include "box/links.hpp"
#include "box/self_test.hpp"
#include "box/this_box.hpp"
#include "forward/flow.hpp"
#include "gateway/crowding.hpp"
#include "gateway/file_return.hpp"
#include "gateway/listen_sockets.hpp"
#include "gateway/listeners.hpp"
#include "gateway/lookout.hpp"
#include "gateway/options.hpp"
#include "gateway/report_rows.hpp"
#include "gateway/roster.hpp"
#include "host/service.hpp"
#include "intake/icd_routes.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "panel/lines.hpp"
#include "settings/board.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// Checked parts of a gateway.
struct Parts {
  const Options& options;          // outlives the gateway
  admin::Store& store;             // outlives the gateway
  admin::FactoryReset& reset;      // outlives the gateway
  admin::TakingOver& taking_over;  // outlives the gateway
  ListenSockets& sockets;          // outlives the gateway
  admin::Store::Loaded loaded;
  std::string trouble;    // why other settings are in use than wanted, or ""
  std::string put_aside;  // queued messages put aside, and why; or ""
  std::string stuck;      // why a take-over is unfinished and the box stands by, or ""
  ledger::Ledger ledger;
  std::chrono::seconds file_rest;  // until unreadable files are tried again
  settings::Board board;
  std::string board_trouble;  // why the board's file is ignored, or ""
  std::unique_ptr<panel::Lines> lines;
  std::unique_ptr<panel::ButtonLine> button;  // null: no button
  std::string runtime_folder;
};

/// Adit at work: the flow, the listeners, the page and the box.
class Gateway final : public api::Source, public api::Operator {
 public:
  Gateway(loop::Loop& loop, Parts parts);

  /// Listens and connects. An error names the failed step.
  std::expected<void, std::string> start();
  /// Rejects new messages, waits for answers in flight, stores messages, and stops the loop.
  void stop();
  /// It stopped for a restart from the disk.
  bool makes_way() const { return makes_way_; }
  /// It runs without a necessary file and restarts when the file returns.
  bool awaits_files() const { return file_return_.has_value(); }
  /// For the watchdog.
  std::vector<loop::Workers*> threads();
  /// A line for systemd.
  std::string status_line() const;

  api::RunView view() const override;
  std::vector<api::ReportRow> reports(std::int64_t after, std::size_t most) const override;
  api::ReportCounts report_counts() const override;
  std::optional<api::ReportDetail> report(std::int64_t number) const override;
  std::expected<std::int64_t, std::string> judge(std::int64_t number, api::Action action) override {
    return flow_.judge(number, action);
  }
  std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report, bool resubmit) override {
    return flow_.report(report, resubmit);
  }
  std::expected<void, std::string> rejected(std::uint64_t number, api::RejectedAction action) override {
    return flow_.rejected(number, action);
  }
  std::expected<void, std::string> acknowledge(const std::string& id) override;
  std::int64_t begin_run() override { return flow_.begin_run(); }
  icd::Checked<std::string> begin_ledger() override;
  api::Time identify(double seconds) override;
  const picture::Mosaic& map() const override { return flow_.picture(); }
  api::MarkerChanges markers(std::uint64_t since) const override {
    return flow_.as_forwarded().markers().changes(since);
  }
  std::vector<api::Track> tracks(api::Time since) const override {
    return flow_.as_forwarded().tracks().since(since);
  }

 private:
  void make_way();
  void end();
  void finish();
  void every_second();
  void look_at_clock();
  void keep_sessions();
  void look_at_sockets();
  void log_crowding();
  /// At the start.
  bool has_read_all() const;
  void await_files();
  void files_are_back();
  void show_lights();
  void add_to(api::Usage& usage) const;
  std::expected<void, std::string> listen(const settings::Team& team);
  void apply_change();
  std::expected<void, std::string> take_over(admin::Store::Loaded next);
  void tell_of_settings(const settings::Restarts& restarts, const forward::Tokens& tokens);
  void reopen_panel();
  clock::Ntp wanted_ntp() const;
  void revert(const std::string& why);
  intake::IcdOptions icd_options() const;
  forward::Tokens tokens() const;
  icd::Redaction redaction() const;
  std::string unread() const;
  void note_robot(const std::string& name);
  void assert_states();
  void pressed(panel::Press press);
  void show_address();
  std::string team_address() const;
  alarms::Facts facts(const std::vector<api::ActivityRow>& activities) const;
  void add_flow(alarms::Facts& facts) const;
  void add_reports(alarms::Facts& facts) const;
  void add_box(alarms::Facts& facts) const;
  std::vector<alarms::Alarm> alarms() const { return board_.shown(conditions_, looked_at_); }
  void judge(api::RunView& view) const;
  void look_for_alarms();
  std::string report_under_way() const;
  std::expected<spare::Content, std::string> content() const;
  std::vector<api::EndpointRow> endpoints() const;

  loop::Loop& loop_;
  Parts parts_;
  settings::Settings settings_;  // with the course in use
  loop::Writer disk_writer_;     // of the state directory; no map waits for it
  forward::Flow flow_;           // its workers end before that writer
  loop::Workers log_ins_;        // separate: log-ins and maps do not wait for each other
  box::Lights lights_;
  box::Links links_;
  box::ButtonWatch button_;
  Roster roster_;
  admin::SessionKeeper sessions_;
  admin::Accounts accounts_;
  host::RootProgram<network::Status> adit_network_;
  admin::Setup setup_;
  box::ThisBox box_;
  admin::NetworkChange network_;
  box::SelfTest self_test_;
  admin::Updates updates_;
  admin::ClockSetting clock_;
  admin::Spare spare_;
  api::Api api_;
  intake::IcdRoutes routes_;
  Crowding crowding_;
  Lookout lookout_;
  alarms::Board board_;
  std::vector<alarms::Condition> conditions_;  // as of looked_at_
  double looked_at_ = 0;                       // alarms::Facts::now
  admin::AcknowledgedFile acknowledged_;
  intake::TokenGuesses guesses_;
  Listeners listeners_;
  loop::Source second_, change_;
  loop::Instant sessions_kept_{};
  std::optional<FileReturn> file_return_;
  bool makes_way_ = false;
  mutable ReadAnswers answers_;  // of the view's reports
  std::string notified_;
  std::map<std::string, std::string> notices_;  // box/notices.hpp
  panel::Lights told_lights_{};                 // the lights as sent to pages
};

}  // namespace adit::gateway
