#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "admin/spare_file.hpp"
#include "admin/spare_stick.hpp"
#include "admin/taking_over.hpp"
#include "api/spare.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "spare/content.hpp"

namespace adit::admin {

/// The box's rest and its export, and the taking in of another's (firmware/spare/README.md).
class Spare final : public api::Spare {
 public:
  /// What the gateway does for it. Each is called on the loop.
  struct Asked {
    /// All but what this knows itself: of the box and its rest.
    std::function<std::expected<spare::Content, std::string>()> content;
    /// The time of day was set by somebody who knows it.
    std::function<bool()> is_time_set;
    /// The gateway ends, and another takes its place, which looks at the files again.
    std::function<void()> restart;
  };

  /// `status_folder`: where adit-spare answers. `stuck`: why the box is on standby whatever
  /// its own file says (a take-over is not finished, the settings cannot be read), or "". `workers`: for what
  /// costs 0.1 s. All outlive this.
  Spare(loop::Loop& loop, loop::Workers& workers, TakingOver& taking_over, std::string state_folder,
        const std::string& status_folder, const std::string& stuck, Asked asked);

  /// Why the box takes nothing and sends nothing; "": it does.
  const std::string& standby() const { return standby_; }
  /// Why its own file could not be read, or "".
  const std::string& unread() const { return unread_; }
  bool is_stuck() const { return !stuck_.empty(); }
  /// Nothing is under way any more as this gateway ends: what /api/status would answer now.
  void ends(const std::optional<icd::RunStatus>& expected);

  api::SpareView spare() const override;
  icd::Checked<void> stand_by() override;
  icd::Checked<void> resume() override;
  void export_to(Sealed done) override;
  void export_to_stick(Done done) override;
  icd::Checked<void> take_from_stick(const std::string& name) override;
  icd::Checked<void> take_in(std::string file) override;
  void open(const std::string& code, Done done) override;
  icd::Checked<void> forget() override;
  icd::Checked<void> take_over() override;

 private:
  icd::Checked<void> keep(const SpareFile& next);
  bool is_of_this_rest(const std::string& file) const;
  /// The export's file, and where the team finds the box.
  using Named = std::function<void(icd::Checked<std::string> file, const std::string& name)>;
  void seal(const Named& done);
  void taken_from_stick(std::string file);
  icd::Checked<void> opened(std::expected<std::string, std::string> text);

  loop::Loop& loop_;
  loop::Workers& workers_;
  TakingOver& taking_over_;
  std::string state_;
  SpareStick stick_;
  std::string stuck_, unread_;
  Asked asked_;
  loop::Source restart_;  // once who asked is answered
  SpareFile file_;
  std::string standby_;
  bool goes_on_standby_ = false;  // with the end of this gateway
  bool takes_over_ = false;
  std::shared_ptr<const std::string> sealed_;  // taken in, and not opened yet; null: nothing is
  std::optional<spare::Content> taken_in_;
  std::vector<std::string> left_out_;  // of its settings: their paths
};

}  // namespace adit::admin
