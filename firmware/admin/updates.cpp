#include "admin/updates.hpp"

#include <sys/statvfs.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "admin/nonce.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "update/health.hpp"

namespace adit::admin {
namespace {

icd::Refusal conflicting(std::string sentence) {
  return {icd::Status::Conflict, std::move(sentence)};
}

/// What is said to be done before adit-update says so itself.
const char* doing_of(update::Request::What what) {
  using What = update::Request::What;
  return what == What::Restart || what == What::Back ? "restarting" : "checking";
}

/// Why a bundle of that size has no place in the folder.
std::optional<icd::Refusal> no_room(const std::string& folder, std::uint64_t size) {
  struct statvfs disk{};
  if (statvfs(folder.c_str(), &disk) != 0) {
    return icd::Refusal{icd::Status::ServiceUnavailable,
                        "cannot read the free space of the disk: " + std::string(std::strerror(errno))};
  }
  const std::uint64_t free = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free >= size + Updates::kSpared) return std::nullopt;
  return icd::Refusal{icd::Status::ServiceUnavailable,
                      icd::sentence("the bundle has ", size, " bytes, but the disk has room for ",
                                    free > Updates::kSpared ? free - Updates::kSpared : 0)};
}

}  // namespace

Updates::Updates(loop::Loop& loop, loop::Writer& writer, UpdateRequests requests,
                 std::function<std::string()> under_way)
    : loop_(loop), writer_(writer), requests_(std::move(requests)), under_way_(std::move(under_way)) {
  unlink(requests_.part_file().c_str());  // of an upload that a power cut broke off
}

void Updates::refresh() const {
  const loop::Instant now = loop_.now();
  if (read_at_ && now < *read_at_ + kFresh) return;
  read_at_ = now;
  status_ = requests_.status();
}

bool Updates::is_asked() const {
  return asked_ && (!status_ || status_->nonce != asked_->request.nonce);
}

void Updates::every_second() {
  refresh();
  if (!is_asked()) return asked_.reset();
  if (loop_.now() < asked_->at + kTakenUpWithin) return;
  requests_.forget();
  asked_.reset();
  not_taken_up_ = "adit-update did not read the request: see journalctl -u adit-update";
  host::log(host::Level::Error, "adit-update did not read the request");
}

api::UpdateView Updates::update() const {
  refresh();
  api::UpdateView view;
  view.why = status_ ? status_->trouble : "adit-update does not run here: " + status_.error();
  view.managed = view.why.empty();
  if (status_) {
    view.running = status_->running;
    view.doing = status_->doing;
    view.progress = status_->progress;
    view.refusal = status_->refusal;
    view.last = status_->last;
    view.trial = status_->trial;
    view.stray = status_->stray;
    view.stick = status_->stick;
    view.stick_why = status_->stick_trouble;
  }
  if (!not_taken_up_.empty()) view.refusal = not_taken_up_;
  if (receiving_ != nullptr) {
    view.doing = "receiving";
    view.progress = static_cast<int>(100 * receiving_->received() / expected_);
    view.refusal.clear();
  } else if (is_asked()) {
    view.doing = doing_of(asked_->request.what);
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
  if (auto why = no_room(requests_.state_folder(), size)) return std::unexpected(std::move(*why));
  auto upload = UpdateUpload::begin(
      writer_, {.part = requests_.part_file(),
                .whole = requests_.bundle_file(),
                .size = size,
                .resume = std::move(resume),
                .asked = [this, again] { return ask(update::Request::What::Install, again); },
                .over = [this] { receiving_ = nullptr; }});
  if (!upload) return std::unexpected(std::move(upload.error()));
  host::log(host::Level::Notice, "receiving an update", {{"bytes", std::to_string(size)}});
  receiving_ = upload->get();
  expected_ = size;
  not_taken_up_.clear();
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
  update::Request request{.nonce = draw_nonce(), .what = what, .again = again};
  if (const auto asked = requests_.ask(request); !asked) {
    return std::unexpected(icd::Refusal{icd::Status::ServiceUnavailable,
                                        "cannot request it from adit-update: " + asked.error()});
  }
  asked_ = Asked{std::move(request), loop_.now()};
  not_taken_up_.clear();
  return {};
}

}  // namespace adit::admin
