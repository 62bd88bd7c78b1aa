#include "admin/updates.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "admin/refuse.hpp"
#include "host/disk.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "update/health.hpp"

namespace adit::admin {
namespace {

/// Characters of Debian's versions (deb-version(7)).
constexpr std::string_view kOfVersions =
    "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.+~:-";
constexpr std::size_t kLongestLine = 200;

/// The action to show until adit-update reports its own.
const char* doing_of(update::Request::What what) {
  using What = update::Request::What;
  return what == What::Restart || what == What::Back ? "restarting" : "checking";
}

/// Refuses a bundle of that size if it does not fit into the directory.
icd::Checked<void> check_room(const std::string& folder, std::uint64_t size) {
  const auto disk = host::disk_of(folder);
  if (!disk)
    return refuse(icd::Status::ServiceUnavailable,
                  "cannot read the free space of the disk: " + std::string(std::strerror(errno)));
  const std::uint64_t free = disk->free;
  if (free >= size + Updates::kSpared) return {};
  return refuse(icd::Status::ServiceUnavailable,
                icd::sentence("the bundle has ", size, " bytes, but the disk has room for ",
                              free > Updates::kSpared ? free - Updates::kSpared : 0));
}

/// Reads the newer version that apt has, a line that services/pc/newer writes on a PC.
void read_newer(const std::string& path, api::UpdateView& view) {
  const auto text = host::read_if_there(path);
  if (!text) view.newer_why = text.error();
  if (!text || !*text) return;
  const std::string line(std::string_view(**text).substr(0, std::min((*text)->find('\n'), kLongestLine)));
  if (line + '\n' == **text && line.find_first_not_of(kOfVersions) == std::string::npos) {
    view.newer = line;
  } else {
    view.newer_why =
        icd::sentence(path, ": expected a version and a line feed, got '", host::escaped(line), "'");
  }
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
  view.runs_here = adit_update_.runs_here();
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
  read_newer(adit_update_.directory() + '/' + update::kNewerFile, view);
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

icd::Checked<void> Updates::check_free() const {
  const api::UpdateView view = update();
  if (!view.managed) return conflict(view.why);
  if (!view.doing.empty()) return conflict(icd::sentence("the box is already ", view.doing, ": wait"));
  return {};
}

icd::Checked<void> Updates::check_installable() const {
  ADIT_TRY(check_free());
  const api::UpdateView view = update();
  if (view.trial) return conflict(update::wait_for_trial(view.running.version));
  return {};
}

icd::Checked<void> Updates::check_stray() const {
  const api::UpdateView view = update();
  if (!view.managed || !view.stray.empty()) return {};
  return conflict(std::string(update::kNoStray));
}

icd::Checked<std::unique_ptr<api::Upload>> Updates::receive(std::uint64_t size, bool again,
                                                            std::function<void()> resume) {
  ADIT_TRY(check_installable());
  ADIT_TRY(check_room(adit_update_.requests(), size));
  auto upload = ADIT_TRY(UpdateUpload::begin(
      writer_, {.part = part_file(),
                .whole = bundle_file(),
                .size = size,
                .resume = std::move(resume),
                .asked = [this, again] { return ask(update::Request::What::Install, again); },
                .over = [this] { receiving_ = nullptr; }}));
  host::log(host::Level::Notice, "receiving an update", {{"bytes", std::to_string(size)}});
  receiving_ = upload.get();
  expected_ = size;
  return std::unique_ptr<api::Upload>(std::move(upload));
}

icd::Checked<void> Updates::install_from_stick(bool again) {
  ADIT_TRY(check_installable());
  return ask(update::Request::What::Stick, again);
}

icd::Checked<void> Updates::restart(bool anyway) {
  return ask_for_restart(update::Request::What::Restart, anyway);
}

icd::Checked<void> Updates::go_back(bool anyway) {
  ADIT_TRY(check_stray());
  return ask_for_restart(update::Request::What::Back, anyway);
}

icd::Checked<void> Updates::stay() {
  ADIT_TRY(check_stray());
  ADIT_TRY(check_free());
  return ask(update::Request::What::Stay, false);
}

icd::Checked<void> Updates::ask_for_restart(update::Request::What what, bool anyway) {
  ADIT_TRY(check_free());
  const std::string report = anyway ? "" : under_way_();
  if (!report.empty()) return conflict(report);
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
