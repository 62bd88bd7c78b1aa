#include "admin/updates.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include "admin/refuse.hpp"
#include "host/disk.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "update/health.hpp"

namespace adit::admin {
namespace {

icd::Refusal conflicting(std::string sentence) {
  return {icd::Status::Conflict, std::move(sentence)};
}

/// The action to show until adit-update reports its own.
const char* doing_of(update::Request::What what) {
  using What = update::Request::What;
  return what == What::Restart || what == What::Back ? "restarting" : "checking";
}

/// Why a bundle of that size does not fit into the directory.
std::optional<icd::Refusal> no_room(const std::string& folder, std::uint64_t size) {
  const auto disk = host::disk_of(folder);
  if (!disk) {
    return icd::Refusal{icd::Status::ServiceUnavailable,
                        "cannot read the free space of the disk: " + std::string(std::strerror(errno))};
  }
  const std::uint64_t free = disk->free;
  if (free >= size + Updates::kSpared) return std::nullopt;
  return icd::Refusal{icd::Status::ServiceUnavailable,
                      icd::sentence("the bundle has ", size, " bytes, but the disk has room for ",
                                    free > Updates::kSpared ? free - Updates::kSpared : 0)};
}

}  // namespace

Updates::Updates(loop::Loop& loop, loop::Writer& writer, const std::string& state_folder,
                 const std::string& status_folder, std::function<std::string()> under_way)
    : writer_(writer),
      adit_update_(loop, "adit-update", state_folder, status_folder, kTakenUpWithin),
      under_way_(std::move(under_way)) {
  unlink(part_file().c_str());  // left by a power cut
}

void Updates::every_second() {
  if (adit_update_.check()) unlink(bundle_file().c_str());
}

api::UpdateView Updates::update() const {
  const auto status = adit_update_.status();
  api::UpdateView view;
  view.why = status ? status->trouble : adit_update_.why();
  view.managed = view.why.empty();
  if (status) {
    view.running = status->running;
    view.doing = status->doing;
    view.progress = status->progress;
    view.refusal = status->refusal;
    view.last = status->last;
    view.trial = status->trial;
    view.stray = status->stray;
    view.stick = status->stick;
    view.stick_why = status->stick_trouble;
  }
  if (auto trouble = adit_update_.trouble(); !trouble.empty()) view.refusal = std::move(trouble);
  if (receiving_ != nullptr) {
    view.doing = "receiving";
    view.progress = static_cast<int>(100 * receiving_->received() / expected_);
    view.refusal.clear();
  } else if (adit_update_.waits()) {
    view.doing = doing_of(asked_);
    view.refusal.clear();
  }
  return view;
}

std::optional<icd::Refusal> Updates::hindrance() const {
  const api::UpdateView view = update();
  if (!view.managed) return conflicting(view.why);
  if (!view.doing.empty()) return conflicting(icd::sentence("the box is already ", view.doing, ": wait"));
  return std::nullopt;
}

std::optional<icd::Refusal> Updates::nothing_installed_now() const {
  if (auto why = hindrance()) return why;
  const api::UpdateView view = update();
  if (view.trial) return conflicting(update::wait_for_trial(view.running.version));
  return std::nullopt;
}

std::optional<icd::Refusal> Updates::no_stray() const {
  const api::UpdateView view = update();
  if (!view.managed || !view.stray.empty()) return std::nullopt;
  return conflicting(std::string(update::kNoStray));
}

icd::Checked<std::unique_ptr<api::Upload>> Updates::receive(std::uint64_t size, bool again,
                                                            std::function<void()> resume) {
  if (auto why = nothing_installed_now()) return std::unexpected(std::move(*why));
  if (auto why = no_room(adit_update_.requests(), size)) return std::unexpected(std::move(*why));
  auto upload = UpdateUpload::begin(
      writer_, {.part = part_file(),
                .whole = bundle_file(),
                .size = size,
                .resume = std::move(resume),
                .asked = [this, again] { return ask(update::Request::What::Install, again); },
                .over = [this] { receiving_ = nullptr; }});
  if (!upload) return std::unexpected(std::move(upload.error()));
  host::log(host::Level::Notice, "receiving an update", {{"bytes", std::to_string(size)}});
  receiving_ = upload->get();
  expected_ = size;
  return std::unique_ptr<api::Upload>(std::move(*upload));
}

icd::Checked<void> Updates::install_from_stick(bool again) {
  if (auto why = nothing_installed_now()) return std::unexpected(std::move(*why));
  return ask(update::Request::What::Stick, again);
}

icd::Checked<void> Updates::restart(bool anyway) {
  return ask_for_restart(update::Request::What::Restart, anyway);
}

icd::Checked<void> Updates::go_back(bool anyway) {
  if (auto why = no_stray()) return std::unexpected(std::move(*why));
  return ask_for_restart(update::Request::What::Back, anyway);
}

icd::Checked<void> Updates::stay() {
  if (auto why = no_stray()) return std::unexpected(std::move(*why));
  if (auto why = hindrance()) return std::unexpected(std::move(*why));
  return ask(update::Request::What::Stay, false);
}

icd::Checked<void> Updates::ask_for_restart(update::Request::What what, bool anyway) {
  if (auto why = hindrance()) return std::unexpected(std::move(*why));
  const std::string report = anyway ? "" : under_way_();
  if (!report.empty()) return std::unexpected(conflicting(report));
  return ask(what, false);
}

icd::Checked<void> Updates::ask(update::Request::What what, bool again) {
  const update::Request request{.nonce = host::draw_nonce(), .what = what, .again = again};
  asked_ = what;
  if (const auto asked = adit_update_.ask(update::kRequestFile, request); !asked)
    return refuse(icd::Status::ServiceUnavailable, "cannot request it from adit-update: " + asked.error());
  return {};
}

}  // namespace adit::admin
