#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "api/updates.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "update/messages.hpp"

namespace adit::admin {

/// A bundle that the writer thread stores on arrival. A slow disk slows the sender, never blocks the loop.
class UpdateUpload final : public api::Upload {
 public:
  /// Bytes collected for one write. The sender is paused if as many are queued during a write.
  static constexpr std::size_t kTogether = 256 << 10;

  /// Data and callbacks of the caller. All but `part` and `whole` are used on the loop.
  struct Callbacks {
    std::string part, whole;                              // path during the upload, and afterwards
    std::uint64_t size = 0;                               // announced size
    std::function<void()> resume;                         // accept more data
    std::function<icd::Checked<void>()> request_install;  // the file is complete: requests the installation
    std::function<void()> on_over;                        // the upload is finished or abandoned
  };
  /// Error: the file cannot be created. `writer` must outlive this object.
  static icd::Checked<std::unique_ptr<UpdateUpload>> begin(loop::Writer& writer, Callbacks ends);
  ~UpdateUpload() override;
  UpdateUpload(const UpdateUpload&) = delete;
  UpdateUpload& operator=(const UpdateUpload&) = delete;

  bool write(std::span<const std::uint8_t> piece) override;
  void finish(std::function<void(icd::Checked<void>)> done) override;
  std::uint64_t received_bytes() const;

 private:
  class WriteJob;
  explicit UpdateUpload(std::shared_ptr<WriteJob> writing) : writing_(std::move(writing)) {}
  std::shared_ptr<WriteJob> writing_;  // shared with the writer's jobs
};

/// The operator's updates of the box, executed by adit-update.
class Updates final : public api::Updates {
 public:
  /// Time in which adit-update must read a request.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// Bytes left free beside a bundle, above all for the ledger.
  static constexpr std::uint64_t kSpared = 16 << 20;

  /// `state_folder`: for requests and bundles. `status_folder`: of adit-update. `under_way`: a sentence about
  /// the report in flight, or "". `loop` and `writer` must outlive this object.
  Updates(loop::Loop& loop, loop::Writer& writer, const std::string& state_folder,
          const std::string& status_folder, std::function<std::string()> under_way);

  api::UpdateView state() const override;
  icd::Checked<std::unique_ptr<api::Upload>> receive(std::uint64_t size, bool again,
                                                     std::function<void()> resume) override;
  icd::Checked<void> install_from_stick(bool again) override;
  icd::Checked<void> restart(bool anyway) override {
    return ask_for_restart(update::Request::Command::Restart, anyway);
  }
  icd::Checked<void> restart_proven_slot(bool anyway) override;
  icd::Checked<void> keep_running_slot() override;

  /// Call each second: reads the result of the last request.
  void every_second();

  /// Whether a bundle is being received, checked or installed, or the box is about to restart.
  bool running() const { return !state().status.doing.empty(); }

 private:
  /// Path of a bundle, and during its upload.
  std::string bundle_file() const { return adit_update_.requests() + '/' + update::kBundleFile; }
  std::string part_file() const { return bundle_file() + ".part"; }
  /// Refuses if requests are impossible now.
  icd::Checked<void> check_free() const;
  /// Refuses if no update can be installed now.
  icd::Checked<void> check_installable() const;
  /// Refuses if no unexpected slot runs.
  icd::Checked<void> check_stray() const;
  /// Requests a restart. Rejected while a report is in flight, unless `anyway`.
  icd::Checked<void> ask_for_restart(update::Request::Command what, bool anyway);
  icd::Checked<void> ask(update::Request::Command what, bool again);

  loop::Writer& writer_;
  host::RootProgram<update::Status> adit_update_;
  std::function<std::string()> under_way_;
  std::uint64_t expected_ = 0;               // bytes of the present upload, or 0
  const UpdateUpload* receiving_ = nullptr;  // the present upload, or null
  update::Request::Command asked_{};         // last request
};

}  // namespace adit::admin
