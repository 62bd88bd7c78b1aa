#include "admin/updates.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "host/disk.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/regular_file.hpp"
#include "update/health.hpp"

namespace adit::admin {
namespace {

icd::Refusal write_refusal(const std::string& why) {
  return {icd::Status::ServiceUnavailable, "cannot write the bundle: " + why};
}

}  // namespace

/// Runs on the loop, except write_now(), which runs once at a time in the writer thread.
class UpdateUpload::WriteJob : public std::enable_shared_from_this<WriteJob> {
 public:
  WriteJob(loop::Writer& writer, Callbacks ends, loop::FileDescriptor file)
      : writer_(writer), ends_(std::move(ends)), file_(std::move(file)) {}

  bool consume(std::span<const std::uint8_t> piece) {
    received_ += piece.size();
    waiting_.insert(waiting_.end(), piece.begin(), piece.end());
    if (waiting_.size() < kTogether) return true;
    held_ = busy_;
    if (!busy_) write_waiting();
    return !held_;
  }

  void finish(std::function<void(icd::Checked<void>)> done) {
    done_ = std::move(done);
    if (!busy_) resume();
  }

  void drop() {
    ends_.resume = [] {};
    if (!dropped_ && !done_) {
      dropped_ = true;
      unlink(ends_.part.c_str());
      ends_.on_over();
    }
  }

  std::uint64_t received_bytes() const { return received_; }

 private:
  void write_waiting() {
    busy_ = true;
    writer_.submit(
        [self = shared_from_this(), bytes = std::exchange(waiting_, {})] { self->write_now(bytes); },
        [self = shared_from_this()] {
          self->busy_ = false;
          self->resume();
        },
        [self = shared_from_this()] {
          self->busy_ = false;
          self->error_ = ENOMEM;
          self->resume();
        });
  }

  void write_now(std::span<const std::uint8_t> bytes) {
    if (error_ == 0)
      error_ =
          loop::write_all(file_.get(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, written_);
    written_ += bytes.size();
    // Spreads the flushes, so that the last one is short.
    if (error_ == 0 && fdatasync(file_.get()) != 0) error_ = errno;
    // Frees the space at once, because the ledger may need it while the rest arrives.
    if (error_ != 0 && ftruncate(file_.get(), 0) != 0) file_ = {};
  }

  void resume() {
    if (dropped_) return;
    if (done_) {
      if (!waiting_.empty() && error_ == 0) return write_waiting();
      return end();
    }
    if (std::exchange(held_, false)) {
      write_waiting();
      ends_.resume();
    }
  }

  void end() {
    icd::Checked<void> outcome = check_complete();
    if (!outcome) unlink(ends_.part.c_str());
    dropped_ = true;
    ends_.on_over();
    std::exchange(done_, {})(std::move(outcome));
  }

  icd::Checked<void> check_complete() {
    if (error_ != 0) return std::unexpected(write_refusal(std::strerror(error_)));
    if (received_ != ends_.size)
      return std::unexpected(write_refusal(icd::sentence("got ", received_, " of ", ends_.size, " bytes")));
    file_ = loop::FileDescriptor();  // adit-update rejects a file that is open for writing
    if (std::rename(ends_.part.c_str(), ends_.whole.c_str()) != 0)
      return std::unexpected(write_refusal(std::strerror(errno)));
    return ends_.request_install();
  }

  loop::Writer& writer_;
  Callbacks ends_;
  loop::FileDescriptor file_;
  std::vector<std::uint8_t> waiting_;
  std::uint64_t received_ = 0;
  std::size_t written_ = 0;  // this and error_: set in the writer thread, read while it is idle
  int error_ = 0;
  bool busy_ = false;     // the writer thread is writing
  bool held_ = false;     // the sender is paused
  bool dropped_ = false;  // finished or abandoned
  std::function<void(icd::Checked<void>)> done_;
};

icd::Checked<std::unique_ptr<UpdateUpload>> UpdateUpload::begin(loop::Writer& writer, Callbacks ends) {
  unlink(ends.part.c_str());
  loop::FileDescriptor file(
      ::open(ends.part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (!file) return std::unexpected(write_refusal(std::strerror(errno)));
  return std::unique_ptr<UpdateUpload>(
      new UpdateUpload(std::make_shared<WriteJob>(writer, std::move(ends), std::move(file))));
}

UpdateUpload::~UpdateUpload() {
  writing_->drop();
}

bool UpdateUpload::write(std::span<const std::uint8_t> piece) {
  return writing_->consume(piece);
}

void UpdateUpload::finish(std::function<void(icd::Checked<void>)> done) {
  writing_->finish(std::move(done));
}

std::uint64_t UpdateUpload::received_bytes() const {
  return writing_->received_bytes();
}

namespace {

/// Characters of Debian's versions (deb-version(7)).
constexpr std::string_view kOfVersions =
    "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.+~:-";
constexpr std::size_t kLongestLine = 200;

/// The action to show until adit-update reports its own.
const char* pending_action(update::Request::Command what) {
  using Command = update::Request::Command;
  return what == Command::Restart || what == Command::Back ? "restarting" : "checking";
}

icd::Checked<void> check_room(const std::string& folder, std::uint64_t size) {
  const auto disk = host::disk_of(folder);
  if (!disk)
    return icd::refuse(icd::Status::ServiceUnavailable,
                       "cannot read the free space of the disk: " + std::string(std::strerror(errno)));
  const std::uint64_t free = disk->free;
  if (free >= size + Updates::kSpared) return {};
  return icd::refuse(icd::Status::ServiceUnavailable, "the bundle has ", size,
                     " bytes, but the disk has room for ",
                     free > Updates::kSpared ? free - Updates::kSpared : 0);
}

/// Reads the newer version that apt has, a line that services/pc/newer writes on a PC.
void read_newer(const std::string& path, api::UpdateView& view) {
  const auto text = host::read_optional_file(path);
  if (!text) view.newer_why = text.error();
  if (!text || !*text) return;
  const std::string line(std::string_view(**text).substr(0, std::min((*text)->find('\n'), kLongestLine)));
  if (line + '\n' == **text && line.find_first_not_of(kOfVersions) == std::string::npos) {
    view.newer = line;
  } else {
    view.newer_why =
        icd::sentence(path, ": expected a version and a line feed, got '", host::escape(line), "'");
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

api::UpdateView Updates::state() const {
  const auto status = adit_update_.status();
  api::UpdateView view;
  view.why = status ? status->trouble : adit_update_.status_error();
  view.managed = view.why.empty();
  view.runs_here = adit_update_.runs_here();
  if (status) view.status = *status;
  read_newer(adit_update_.directory() + '/' + update::kNewerFile, view);
  if (auto trouble = adit_update_.trouble(); !trouble.empty()) view.status.refusal = std::move(trouble);
  if (receiving_ != nullptr) {
    view.status.doing = "receiving";
    view.status.progress = static_cast<int>(100 * receiving_->received_bytes() / expected_);
    view.status.refusal.clear();
  } else if (adit_update_.is_pending()) {
    view.status.doing = pending_action(asked_);
    view.status.refusal.clear();
  }
  return view;
}

icd::Checked<void> Updates::check_free() const {
  const api::UpdateView view = state();
  if (!adit_update_.status()) return adit_update_.refuse();
  if (!view.managed) return icd::conflict(view.why);
  if (!view.status.doing.empty()) return icd::conflict("the box is already ", view.status.doing, ": wait");
  return {};
}

icd::Checked<void> Updates::check_installable() const {
  ADIT_TRY(check_free());
  const api::UpdateView view = state();
  if (view.status.trial) return icd::conflict(update::wait_for_trial(view.status.running.version));
  return {};
}

icd::Checked<void> Updates::check_stray() const {
  const api::UpdateView view = state();
  if (!view.managed || !view.status.stray.empty()) return {};
  return icd::conflict(update::kNoStray);
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
                .request_install = [this, again] { return ask(update::Request::Command::Install, again); },
                .on_over = [this] { receiving_ = nullptr; }}));
  host::log(host::Level::Notice, "receiving an update", {{"bytes", std::to_string(size)}});
  receiving_ = upload.get();
  expected_ = size;
  return std::unique_ptr<api::Upload>(std::move(upload));
}

icd::Checked<void> Updates::install_from_stick(bool again) {
  ADIT_TRY(check_installable());
  return ask(update::Request::Command::Stick, again);
}

icd::Checked<void> Updates::restart_proven_slot(bool anyway) {
  ADIT_TRY(check_stray());
  return ask_for_restart(update::Request::Command::Back, anyway);
}

icd::Checked<void> Updates::keep_running_slot() {
  ADIT_TRY(check_stray());
  ADIT_TRY(check_free());
  return ask(update::Request::Command::Stay, false);
}

icd::Checked<void> Updates::ask_for_restart(update::Request::Command what, bool anyway) {
  ADIT_TRY(check_free());
  const std::string report = anyway ? "" : under_way_();
  if (!report.empty()) return icd::conflict(report);
  return ask(what, false);
}

icd::Checked<void> Updates::ask(update::Request::Command what, bool again) {
  const update::Request request{.nonce = host::draw_nonce(), .what = what, .again = again};
  asked_ = what;
  if (const auto asked = adit_update_.ask(update::kRequestFile, request); !asked)
    return icd::refuse(icd::Status::ServiceUnavailable,
                       "cannot request it from adit-update: " + asked.error());
  return {};
}

}  // namespace adit::admin
