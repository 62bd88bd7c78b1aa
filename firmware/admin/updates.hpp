#pragma once

#include <functional>
#include <optional>
#include <string>

#include "admin/update_upload.hpp"
#include "api/updates.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "update/messages.hpp"

namespace adit::admin {

/// The operator's updates of the box, as adit-update makes them.
class Updates final : public api::Updates {
 public:
  /// adit-update begins within that time, unless it does not run here.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// What stays free on the disk beside a bundle: for the ledger above all.
  static constexpr std::uint64_t kSpared = 16 << 20;

  /// `state_folder`: where requests and bundles are left; `status_folder`: where adit-update answers.
  /// `under_way`: a sentence about the report that the Command Post is being sent, or "". All outlive this.
  Updates(loop::Loop& loop, loop::Writer& writer, const std::string& state_folder,
          const std::string& status_folder, std::function<std::string()> under_way);

  api::UpdateView update() const override;
  icd::Checked<std::unique_ptr<api::Upload>> receive(std::uint64_t size, bool again,
                                                     std::function<void()> resume) override;
  icd::Checked<void> install_from_stick(bool again) override;
  icd::Checked<void> restart(bool anyway) override;
  icd::Checked<void> go_back(bool anyway) override;
  icd::Checked<void> stay() override;

  /// Called each second: takes note of what became of the last request.
  void every_second();

  /// Something is being received, checked or installed, or the box is about to be restarted.
  bool running() const { return !update().doing.empty(); }

 private:
  /// Where a bundle is left, and where it is while it comes in.
  std::string bundle_file() const { return adit_update_.requests() + '/' + update::kBundleFile; }
  std::string part_file() const { return bundle_file() + ".part"; }
  /// Why nothing can be asked for now; nothing: it can.
  std::optional<icd::Refusal> hindrance() const;
  /// Why nothing is installed now.
  std::optional<icd::Refusal> nothing_installed_now() const;
  /// There is no slot to go back to.
  std::optional<icd::Refusal> no_stray() const;
  /// Why the box is not restarted into that: also, unless `anyway`, while a report is under way.
  icd::Checked<void> ask_for_restart(update::Request::What what, bool anyway);
  icd::Checked<void> ask(update::Request::What what, bool again);

  loop::Writer& writer_;
  host::RootProgram<update::Status> adit_update_;
  std::function<std::string()> under_way_;
  std::uint64_t expected_ = 0;               // bytes of what is being received; 0: nothing is
  const UpdateUpload* receiving_ = nullptr;  // while it is
  update::Request::What asked_{};            // last
};

}  // namespace adit::admin
