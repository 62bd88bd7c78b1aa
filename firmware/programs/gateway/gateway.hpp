#pragma once

#include <expected>
#include <string>
#include <vector>

#include "admin/certificate.hpp"
#include "admin/kept_file.hpp"
#include "admin/setup.hpp"
#include "admin/team_ports.hpp"
#include "api/api.hpp"
#include "box/lights.hpp"
#include "box/self_test.hpp"
#include "box/this_box.hpp"
#include "gateway/file_return.hpp"
#include "gateway/overview.hpp"
#include "host/service.hpp"
#include "intake/icd_routes.hpp"
#include "loop/workers.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// The box's IPv4 address for the team. "": it has none, or it cannot be read, which is logged.
std::string team_address(const settings::Team& team);

/// Adit at work: the flow, the listeners, the page and the box.
class Gateway final : public api::GatewayControl {
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
  std::string status_line() const { return overview_.status_line(); }

  std::expected<void, std::string> acknowledge(const std::string& id) override;
  icd::Checked<std::string> begin_ledger() override;
  api::Time identify(double seconds) override;

 private:
  void make_way();
  void end();
  void every_second();
  void check_clock();
  void keep_sessions();
  void check_sockets();
  /// At the start.
  bool has_read_all() const;
  void await_files();
  void on_files_readable();
  void show_lights();
  std::expected<void, std::string> listen(const settings::Team& team);
  void apply_change();
  std::expected<void, std::string> take_over(admin::Store::LoadedSettings next);
  void log_settings(const settings::Restarts& restarts, const forward::Tokens& tokens);
  void reopen_panel();
  /// std::nullopt: the box's addresses cannot be read, so the last request stays.
  std::optional<clock::Ntp> wanted_ntp() const;
  void revert(const std::string& why);
  intake::IcdOptions icd_options() const;
  forward::Tokens tokens() const;
  icd::Redaction redaction() const;
  std::string unread() const;
  void on_pressed(panel::Press press);

  loop::Loop& loop_;
  Parts parts_;
  settings::Settings settings_;  // with the course in use
  loop::Writer disk_writer_;     // of the state directory; no map waits for it
  forward::Flow flow_;           // its workers end before that writer
  loop::Workers log_ins_;        // separate: log-ins and maps do not wait for each other
  box::Lights lights_;
  box::Links links_;
  box::ButtonWatch button_;
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
  admin::Certificate certificate_;
  Overview overview_;
  api::Api api_;
  intake::IcdRoutes routes_;
  intake::TokenGuesses guesses_;
  Listeners listeners_;
  admin::TeamPorts team_ports_;
  loop::Source second_, change_;
  loop::Instant sessions_kept_{};
  std::optional<FileReturn> file_return_;
  bool makes_way_ = false;
  std::string notified_;
  panel::Lights told_lights_{};  // the lights as sent to pages
};

}  // namespace adit::gateway
