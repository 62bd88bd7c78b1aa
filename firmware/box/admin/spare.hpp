#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "admin/takeover.hpp"
#include "api/spare.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "spare/content.hpp"
#include "spare/stick.hpp"

namespace adit::admin {

/// Exports to and from the USB stick in the box, copied by adit-spare (firmware/rules/spare/README.md).
class SpareStick {
 public:
  /// Time in which adit-spare must read a request.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// Interval at which a request's result is read.
  static constexpr std::chrono::milliseconds kLook{100};

  using Taken = std::function<void(std::string)>;

  /// `state_folder`: requests. `status_folder`: answers. `taken` gets each read export. `loop` outlives this.
  SpareStick(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder,
             Taken taken);

  /// std::nullopt: adit-spare does not run here.
  std::optional<api::StickRow> view() const;
  /// Refuses if requests are impossible now.
  icd::Checked<void> check_free() const;
  /// Writes the whole file under that name.
  icd::Checked<void> write(const std::string& name, const std::string& file);
  icd::Checked<void> request_import(const std::string& name);

 private:
  using Command = spare::StickRequest::Command;
  icd::Checked<void> ask(Command what, const std::string& name);
  void poll();
  void finish(const spare::StickStatus& status);
  std::string stick_request_file() const { return adit_spare_.requests() + '/' + spare::kForStickFile; }

  loop::Loop& loop_;
  host::RootProgram<spare::StickStatus> adit_spare_;
  Taken taken_;
  loop::Source timer_;
  std::optional<Command> asked_;  // until it is finished
  std::string refusal_;           // why the last request failed
};

/// The box's standby and its export, and the import of another box's (firmware/rules/spare/README.md).
class Spare final : public api::Spare {
 public:
  /// Functions of the gateway, called on the loop.
  struct Callbacks {
    /// The export's content, without the data about this box and its standby.
    std::function<std::expected<spare::Content, std::string>()> content;
    /// Whether the time of day is reliable.
    std::function<bool()> is_time_set;
    /// Replaces the gateway; the new one reads the files again.
    std::function<void()> restart;
  };

  /// `status_folder`: adit-spare's. `stuck`: why the box is a standby despite its file (unfinished takeover,
  /// unreadable settings), or "". `workers`: jobs of 0.1 s. `loop`, `workers` and `takeover` outlive this.
  Spare(loop::Loop& loop, loop::Workers& workers, Takeover& takeover, std::string state_folder,
        const std::string& status_folder, const std::string& stuck, Callbacks callbacks);

  /// Why the box is a standby, or "".
  const std::string& standby() const { return standby_; }
  /// Why its file could not be read, or "".
  const std::string& unread() const { return unread_; }
  bool is_stuck() const { return !stuck_.empty(); }
  /// Call when the gateway ends without requests in flight. `expected`: the answer of /api/status then.
  void on_end(const std::optional<icd::RunStatus>& expected);

  api::SpareView state() const override;
  icd::Checked<void> enter_standby() override;
  icd::Checked<void> resume() override;
  void export_to(Sealed done) override;
  void export_to_stick(Done done) override;
  icd::Checked<void> import_from_stick(const std::string& name) override;
  icd::Checked<void> import_file(std::string file) override;
  void open(const std::string& code, Done done) override;
  icd::Checked<void> forget() override;
  icd::Checked<void> take_over() override;

 private:
  /// An imported export that was opened.
  struct OpenedExport {
    spare::Content content;
    settings::SavedSettings settings;
  };

  icd::Checked<void> keep(const SpareFile& next);
  bool is_current_export(const std::string& file) const;
  /// `file`: the export. `name`: the box's address for the team.
  using SealCallback = std::function<void(icd::Checked<std::string> file, const std::string& name)>;
  void seal(const SealCallback& done);
  void on_stick_export(std::string file);
  icd::Checked<OpenedExport> check(const std::expected<std::string, std::string>& text) const;

  loop::Loop& loop_;
  loop::Workers& workers_;
  Takeover& takeover_;
  std::string state_;
  SpareStick stick_;
  std::string stuck_, unread_;
  Callbacks callbacks_;
  loop::Source restart_;  // fires after the client has its answer
  SpareFile file_;
  std::string standby_;
  bool goes_on_standby_ = false;  // when this gateway ends
  bool takes_over_ = false;
  std::shared_ptr<const std::string> sealed_;  // imported and not opened yet, or null
  std::optional<OpenedExport> opened_;
};

}  // namespace adit::admin
