#pragma once

#include <chrono>
#include <expected>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "admin/accounts.hpp"
#include "admin/certificate.hpp"
#include "admin/clock_setting.hpp"
#include "admin/factory_reset.hpp"
#include "admin/kept_file.hpp"
#include "admin/network_change.hpp"
#include "admin/spare.hpp"
#include "admin/store.hpp"
#include "admin/takeover.hpp"
#include "admin/updates.hpp"
#include "alarms/board.hpp"
#include "api/box.hpp"
#include "api/source.hpp"
#include "box/lights.hpp"
#include "box/this_box.hpp"
#include "facts/snapshot.hpp"
#include "forward/flow.hpp"
#include "gateway/listeners.hpp"
#include "gateway/observed_facts.hpp"
#include "gateway/options.hpp"
#include "gateway/report_rows.hpp"
#include "host/disk.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "panel/lines.hpp"
#include "settings/board.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// Checked parts of a gateway.
struct Parts {
  const Options& options;      // outlives the gateway
  admin::Store& store;         // outlives the gateway
  admin::FactoryReset& reset;  // outlives the gateway
  admin::Takeover& takeover;   // outlives the gateway
  ListenSockets& sockets;      // outlives the gateway
  admin::Store::LoadedSettings loaded;
  std::string trouble;    // why other settings are in use than wanted, or ""
  std::string put_aside;  // queued messages put aside, and why; or ""
  std::string stuck;      // why a take-over is unfinished and the box stands by, or ""
  ledger::Ledger ledger;
  std::expected<host::Wear, std::string> wear;  // of the state directory's disk
  std::chrono::seconds file_rest;               // until unreadable files are tried again
  settings::Board board;
  std::string board_trouble;  // why the board's file is ignored, or ""
  std::unique_ptr<panel::Lines> lines;
  std::unique_ptr<panel::ButtonLine> button;  // null: no button
  std::string runtime_folder;
};

/// Robots not in the settings: accepted, because the ICD forbids no name, but shown as perhaps misspelt.
class Roster {
 public:
  static constexpr std::chrono::minutes kRecent{2};  // since the last message
  static constexpr std::size_t kMostUnknown = 8;

  explicit Roster(const std::vector<settings::Robot>& robots);

  /// Replaces the list.
  void set_up(const std::vector<settings::Robot>& robots);
  /// Call for each accepted message. True: the first of an unknown robot.
  bool on_posted(const std::string& name, loop::Instant now);
  /// Within kRecent.
  std::vector<std::string> unknown(loop::Instant now) const;
  /// "unknown robot 'x' sends messages; the settings list ugv1, ugv2"
  std::string sentence(const std::string& name) const;
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;                // empty: all names pass
  std::map<std::string, loop::Instant> unknown_;  // last messages
};

/// The state of the whole box. A snapshot is taken once a second and at each reading. Its alarms are found
/// once, and the view, the lights and systemd's line show it.
class Overview final : public api::Source {
 public:
  /// The observed parts of the gateway. All outlive the overview.
  struct Rooms {
    const loop::Loop& loop;
    const Parts& parts;
    const settings::Settings& settings;
    forward::Flow& flow;
    const box::Lights& lights;
    const box::Links& links;
    const admin::Accounts& accounts;
    const admin::NetworkChange& network;
    const admin::Updates& updates;
    const admin::ClockSetting& clock;
    const admin::Spare& spare;
    const admin::Certificate& certificate;
    const Listeners& listeners;
  };

  /// `writer` stores acknowledged alarms and outlives the overview.
  Overview(const Rooms& rooms, loop::Writer& writer);

  /// Call after the flow's start and before any answer.
  void restore();
  /// Call once a second. Also reads the notices, logs rejected connections, and stores acknowledgements.
  void update();
  std::expected<void, std::string> acknowledge(const std::string& id);
  /// Shows the last snapshot, and logs the end of set-up.
  void show_on(box::Lights& lights) const;
  void on_posted(const std::string& robot);
  /// A connection of the team was rejected or closed.
  void on_ended(intake::CloseReason why, const std::string& address);
  void on_settings_changed(const settings::Restarts& restarts);
  /// The time of day was set ahead by `seconds`.
  void on_wall_set(double seconds) { board_.move(seconds); }

  /// A line for systemd.
  std::string status_line() const;
  /// Adds the counts of the flow and of the team's connections.
  void add_to(api::Usage& usage) const;

  api::RunView view() override;
  std::vector<facts::ReportRow> reports(std::int64_t after, std::size_t most) const override;
  api::ReportCounts report_counts() const override { return counts_of(rooms_.flow.reports()); }
  std::optional<api::ReportDetail> report(std::int64_t number) const override;
  const picture::Mosaic& map() const override { return rooms_.flow.picture(); }
  api::MarkerChanges markers(std::uint64_t since) const override {
    return rooms_.flow.delivered_scene().markers().changes(since);
  }
  std::vector<api::Track> tracks(api::Time since) const override {
    return rooms_.flow.delivered_scene().tracks().tracks_after(since);
  }

 private:
  void log_crowding();
  /// Takes a snapshot, and computes view_ and conditions_ from it. `activities`: the present ones.
  void take_snapshot(std::vector<facts::ActivityRow> activities);
  api::RunView view_of(facts::Snapshot snapshot) const;
  facts::Traffic traffic(std::vector<facts::ActivityRow> activities) const;
  facts::Clients clients() const;
  facts::Reports reports() const;
  facts::Box box() const;

  const Rooms rooms_;
  Roster roster_;
  Crowding crowding_;
  ObservedFacts observed_;
  alarms::Board board_;
  api::RunView view_;                          // the last snapshot
  std::vector<alarms::Condition> conditions_;  // its alarms
  admin::AcknowledgementFile acknowledged_;
  mutable ReadAnswers answers_;                 // of the view's reports
  std::map<std::string, std::string> notices_;  // box/this_box.hpp
};

}  // namespace adit::gateway
