/// adit-update: installs updates of the box as root, for aditd, which has no privileges.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "applier/options.hpp"
#include "applier/sticks.hpp"
#include "command_line/read.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/output.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "host/untrusted_folder.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/regular_file.hpp"
#include "update/bundle.hpp"
#include "update/health.hpp"
#include "update/messages.hpp"

namespace adit::applier {
namespace {

// State of adit-update that outlives a boot, in its state directory. A missing file reads as the default. An
// error says what cannot be read, and why. save() returns true once the data survives a power cut.

std::expected<update::LastUpdate, std::string> load_last_update(const std::string& folder);
bool save(const std::string& folder, const update::LastUpdate& last_update);

std::expected<update::ProvenSlot, std::string> load_proven(const std::string& folder);
bool save(const std::string& folder, const update::ProvenSlot& proven);

/// An update's file that other users cannot change during checks and installation.
class BundleFile {
 public:
  /// Takes a file out of a directory in which another user writes. It then has no name, belongs to this user
  /// and is open for writing in no process. After an error it is still removed, if possible.
  static std::expected<BundleFile, std::string> take_file(host::UntrustedFolder& folder,
                                                          const std::string& name);
  /// Opens a file on a read-only file system.
  static std::expected<BundleFile, std::string> open(const std::string& path);

  /// Path of the same file for other programs of this user, valid while this object lives.
  std::string path() const;

 private:
  explicit BundleFile(loop::FileDescriptor file) : file_(std::move(file)) {}
  loop::FileDescriptor file_;
};

/// VERSION_ID of os-release(5) without quotation marks; "" if absent.
std::string version_in(const std::string& path);

/// RAUC as a program. It describes a bundle only after its signature was verified. Errors are sentences.
class Rauc {
 public:
  explicit Rauc(std::string command) : command_(std::move(command)) {}

  /// Board and running slot, without the version. Blocks while RAUC is busy, because it gives no status then.
  std::expected<update::RunningSystem, std::string> status() const;
  std::expected<update::Bundle, std::string> info(const std::string& bundle) const;
  /// Writes the other slot, to start next. `progress`: per cent. After an error RAUC may still be at work.
  std::expected<void, std::string> install(const std::string& bundle,
                                           const std::function<void(int)>& progress) const;
  /// Marks the running slot healthy and resets its count of starts.
  std::expected<void, std::string> mark_good() const;
  /// Starts the other slot next, with all tries. Its content must have been good once.
  std::expected<void, std::string> start_other_next() const;
  /// Starts the running slot next.
  std::expected<void, std::string> start_booted_next() const;
  /// Starts the running slot next, and the other one not before it is written again.
  std::expected<void, std::string> disable_other_slot() const;

 private:
  std::string command_;
};

/// The work of adit-update: executes aditd's requests one after the other and reports the status.
class Updater {
 public:
  /// `options` must outlive this object.
  explicit Updater(const UpdateOptions& options)
      : options_(options), rauc_(options.rauc), file_(options.status + '/' + host::kStatusFile) {}

  /// Answers all requests, then returns. Error: its own directories are unusable, or a request cannot be
  /// removed. Requests from before the boot are dropped, because their senders have seen them fail.
  std::expected<void, std::string> work();

 private:
  void read_status();
  void scan_sticks();
  void answer(const update::Request& request, host::UntrustedFolder& folder);
  /// "", or why it failed.
  std::string install(const std::expected<BundleFile, std::string>& file, bool again);
  std::string abandon_spare_slot();
  std::string write(const BundleFile& file, const update::Bundle& bundle);
  std::string restart();
  std::string restart_proven_slot();
  std::string keep_running_slot();
  void record_update(update::LastUpdate last_update);
  bool write_status() { return file_.write(status_).has_value(); }

  const UpdateOptions& options_;
  Rauc rauc_;
  std::string boot_;
  update::Status status_;
  std::string on_stick_;  // path of status_.stick
  host::StatusFile file_;
};

/// `what`: for the error, as in "cannot read ...".
template <class Message>
std::expected<Message, std::string> load(const std::string& path, std::string_view what) {
  auto kept = host::read_row<Message>(path);
  if (kept) return (*std::move(kept)).value_or(Message{});
  return std::unexpected(icd::sentence("cannot read ", what, ": ", kept.error()));
}

bool save(const std::string& path, const std::string& text, std::string_view what) {
  return host::log_failure(host::Level::Error, "cannot store " + std::string(what),
                           host::write_file(path, text, host::kForAll));
}

constexpr std::string_view kLast = "the outcome of the last update", kGood = "the slot that was good last";

std::expected<update::LastUpdate, std::string> load_last_update(const std::string& folder) {
  return load<update::LastUpdate>(folder + '/' + update::kLastUpdateFile, kLast);
}

bool save(const std::string& folder, const update::LastUpdate& last_update) {
  return save(folder + '/' + update::kLastUpdateFile, codec::write_file(last_update), kLast);
}

std::expected<update::ProvenSlot, std::string> load_proven(const std::string& folder) {
  return load<update::ProvenSlot>(folder + '/' + update::kProvenFile, kGood);
}

bool save(const std::string& folder, const update::ProvenSlot& proven) {
  return save(folder + '/' + update::kProvenFile, codec::write_file(proven), kGood);
}

std::expected<loop::FileDescriptor, std::string> open_plain(const std::string& path,
                                                            const std::string& name) {
  loop::FileDescriptor file = loop::open_regular(path, O_RDONLY | O_NOFOLLOW);
  struct stat status{};
  if (!file || fstat(file.get(), &status) != 0) return std::unexpected(host::path_error(name, errno));
  if (status.st_size == 0) return std::unexpected(name + ": expected a bundle, got an empty file");
  if (std::cmp_greater(status.st_size, update::kLargestBundle)) {
    return std::unexpected(
        icd::sentence(name, ": expected at most ", update::kLargestBundle, " bytes, got ", status.st_size));
  }
  return file;
}

/// Gives the file to this user, so that no other user can open it. The kernel grants the lease only if no
/// process has the file open for writing (fcntl(2)).
std::expected<void, std::string> take_ownership(const loop::FileDescriptor& file, const std::string& name) {
  if (fchown(file.get(), geteuid(), getegid()) != 0 || fchmod(file.get(), S_IRUSR) != 0)
    return std::unexpected(host::path_error(name, errno));
  if (fcntl(file.get(), F_SETLEASE, F_RDLCK) != 0) {
    return std::unexpected(errno == EAGAIN ? name + ": another program is writing to it"
                                           : host::path_error(name, errno));
  }
  fcntl(file.get(), F_SETLEASE, F_UNLCK);
  return {};
}

std::expected<BundleFile, std::string> BundleFile::take_file(host::UntrustedFolder& folder,
                                                             const std::string& name) {
  const std::string path = folder.path_by_descriptor() + '/' + name;
  auto file = open_plain(path, name);
  const auto gone = folder.remove(name);
  if (!file) return std::unexpected(file.error());
  if (!gone) return std::unexpected(gone.error());
  ADIT_TRY(take_ownership(*file, name));
  return BundleFile(std::move(*file));
}

std::expected<BundleFile, std::string> BundleFile::open(const std::string& path) {
  auto file = ADIT_TRY(open_plain(path, path.substr(path.rfind('/') + 1)));
  return BundleFile(std::move(file));
}

std::string BundleFile::path() const {
  return icd::sentence("/proc/", getpid(), "/fd/", file_.get());
}

/// Longest wait for the client of an installation. A slow card takes some minutes. If the client dies or
/// takes longer, status() waits for RAUC itself.
constexpr std::chrono::minutes kInstall{20};
constexpr std::chrono::seconds kRaucAnswer{60};
/// Interval of questions while RAUC is busy.
constexpr std::chrono::seconds kAgain{1};

using update::Fault;

Fault fault_of(const host::Output& said) {
  Fault fault = update::fault_in(said.out, said.err);
  if (fault.sentence.empty()) fault.sentence = "rauc: " + said.trouble;
  return fault;
}

std::expected<std::string, Fault> ask(const std::vector<std::string>& words) {
  host::Output said = host::output_of(words, kRaucAnswer);
  Fault fault = fault_of(said);
  // A success with a "busy" warning lacks the next slot.
  if (!said.trouble.empty() || fault.kind == Fault::Kind::Busy) return std::unexpected(std::move(fault));
  return std::move(said.out);
}

std::expected<void, std::string> mark(const std::string& command, const char* how, const char* slot) {
  if (const auto said = ask({command, "status", how, slot}); !said)
    return std::unexpected(said.error().sentence);
  return {};
}

std::string version_in(const std::string& path) {
  const auto text = host::read_file(path);
  std::string value(text ? update::value_of("VERSION_ID", *text) : "");
  std::erase(value, '"');
  return value;
}

std::expected<update::RunningSystem, std::string> Rauc::status() const {
  const auto until = std::chrono::steady_clock::now() + kInstall;
  const std::vector<std::string> words = {command_, "status", "--output-format=json"};
  auto said = ask(words);
  while (!said && said.error().kind == Fault::Kind::Busy && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(kAgain);
    said = ask(words);
  }
  if (!said) return std::unexpected(said.error().sentence);
  return update::read_status(*said);
}

std::expected<update::Bundle, std::string> Rauc::info(const std::string& bundle) const {
  const auto said = ask({command_, "info", "--output-format=json", bundle});
  if (!said) return std::unexpected(said.error().sentence);
  return update::read_info(*said);
}

std::expected<void, std::string> Rauc::install(const std::string& bundle,
                                               const std::function<void(int)>& progress) const {
  const host::Output said = host::output_of({command_, "install", "--progress", bundle}, kInstall,
                                            [&progress](std::string_view line) {
                                              if (const auto percent = update::percent_in(line))
                                                progress(*percent);
                                            });
  if (said.trouble.empty()) return {};
  return std::unexpected(fault_of(said).sentence);
}

std::expected<void, std::string> Rauc::mark_good() const {
  return mark(command_, "mark-good", "booted");
}

std::expected<void, std::string> Rauc::start_other_next() const {
  if (auto first = mark(command_, "mark-active", "other"); !first) return first;
  return mark(command_, "mark-good", "other");
}

std::expected<void, std::string> Rauc::start_booted_next() const {
  return mark(command_, "mark-active", "booted");
}

/// A bad slot leaves the boot loader's order. Otherwise it gets three more tries once no slot has tries left.
std::expected<void, std::string> Rauc::disable_other_slot() const {
  if (auto first = start_booted_next(); !first) return first;
  return mark(command_, "mark-bad", "other");
}

/// The best update on the mounted USB sticks.
struct StickUpdate {
  std::optional<update::Offer> offer;  // the newest installable one
  std::string path;                    // its file
  std::string trouble;                 // without an offer: why the files cannot be installed, or ""
};

/// Each candidate is read once, which is slow.
constexpr std::size_t kMost = 8;

struct Candidate {
  std::string folder, name;
  update::Promise promise;
};

/// The most promising files of all sticks.
std::vector<Candidate> candidates(const std::string& sticks, const std::string& compatible,
                                  std::string& trouble) {
  std::vector<Candidate> found;
  const auto all = host::names_in(sticks);
  if (!all) trouble = "the sticks: " + all.error();
  for (const std::string& stick : all.value_or(std::vector<std::string>())) {
    const std::string folder = sticks + '/' + stick;
    const auto names = host::names_in(folder, Sticks::kMostAtTop);
    if (!names) trouble = host::escape(stick) + ": " + names.error();
    for (const std::string& name : names.value_or(std::vector<std::string>())) {
      if (update::is_bundle_name(name)) found.push_back({folder, name, update::promise_of(name, compatible)});
    }
  }
  std::ranges::sort(found, [](const Candidate& left, const Candidate& right) {
    return left.promise == right.promise ? left.name < right.name : left.promise > right.promise;
  });
  if (found.size() > kMost) found.resize(kMost);
  return found;
}

/// The update in a file, or why it cannot be installed.
std::expected<update::Offer, std::string> checked_offer(const Candidate& candidate, const Rauc& rauc,
                                                        const update::RunningSystem& running) {
  if (!update::is_plain(candidate.name))
    return std::unexpected("rename the file: only ASCII characters are allowed");
  const auto file = ADIT_TRY(BundleFile::open(candidate.folder + '/' + candidate.name));
  const auto bundle = ADIT_TRY(rauc.info(file.path()));
  if (std::string why = update::refusal_reason(bundle, running, true); !why.empty())
    return std::unexpected(std::move(why));
  return update::Offer{candidate.name, bundle.version};
}

/// Checks files `adit-*.raucb` at the top of each stick, the eight with the most promising names. The sticks
/// are mounted read-only in the directories of `folder`.
StickUpdate find_update(const std::string& folder, const Rauc& rauc, const update::RunningSystem& running) {
  StickUpdate found;
  for (const Candidate& candidate : candidates(folder, running.compatible, found.trouble)) {
    const auto offer = checked_offer(candidate, rauc, running);
    if (!offer) {
      found.trouble = host::escape(candidate.name) + ": " + offer.error();
    } else if (!found.offer ||
               *update::Version::parse(found.offer->version) < *update::Version::parse(offer->version)) {
      found.offer = *offer;
      found.path = candidate.folder + '/' + candidate.name;
    }
  }
  if (found.offer) found.trouble.clear();
  return found;
}

using host::Level;
using update::Stage;

constexpr std::chrono::seconds kRestart{30};
constexpr const char* kNotKept = "cannot store the state of the update";

std::expected<void, std::string> Updater::work() {
  const auto before = file_.read_earlier<update::Status>();
  if (before) status_.nonce = before->nonce;
  boot_ = host::boot();
  read_status();
  scan_sticks();
  if (!write_status()) return std::unexpected("cannot write the status");
  auto done = host::answer_requests<update::Request>(
      {options_.wanted, update::kRequestFile, update::kBundleFile}, !before,
      [this](const update::Request& request, host::UntrustedFolder& folder) { answer(request, folder); });
  if (done) return done;
  status_.trouble = done.error();
  write_status();
  return done;
}

/// Finds the running slot and settles the last update.
void Updater::read_status() {
  const auto running = rauc_.status();
  if (running) {
    status_.running = *running;
  } else {
    status_.trouble = "RAUC does not run here: " + running.error();
  }
  status_.running.version = version_in(options_.os_release);
  const auto read = load_last_update(options_.state);
  const update::LastUpdate kept =  // not saved: the next update replaces an unreadable one
      read ? *read : update::LastUpdate{.stage = Stage::Failed, .why = read.error()};
  update::LastUpdate last_update = running ? update::settle_update(kept, status_.running, boot_) : kept;
  if (last_update.stage == Stage::Left && kept.stage != Stage::Left) {
    host::log_failure(Level::Error, "cannot stop the boot loader from starting the failed update again",
                      rauc_.disable_other_slot());
  }
  if (last_update == kept) {
    status_.last = std::move(last_update);
  } else {
    record_update(std::move(last_update));
  }
  status_.trial = update::on_trial(status_.last, status_.running, boot_);
  const auto proven = load_proven(options_.state);
  status_.stray = proven ? update::slot_warning(*proven, status_.running, status_.trial)
                         : update::stray_if_unknown(status_.running, status_.trial, proven.error());
  if (!status_.stray.empty()) host::log(Level::Error, "unexpected slot started", {{"what", status_.stray}});
}

void Updater::scan_sticks() {
  if (!status_.trouble.empty()) return;
  StickUpdate found = applier::find_update(options_.sticks, rauc_, status_.running);
  status_.stick = std::move(found.offer);
  on_stick_ = std::move(found.path);
  status_.stick_trouble = std::move(found.trouble);
}

void Updater::answer(const update::Request& request, host::UntrustedFolder& folder) {
  using Command = update::Request::Command;
  status_.nonce = request.nonce;
  status_.refusal.clear();
  if (request.what == Command::Install) {
    status_.refusal = install(BundleFile::take_file(folder, update::kBundleFile), request.again);
  } else if (request.what == Command::Restart) {
    status_.refusal = restart();
  } else if (request.what == Command::Back) {
    status_.refusal = restart_proven_slot();
  } else if (request.what == Command::Stay) {
    status_.refusal = keep_running_slot();
  } else if (status_.stick) {
    status_.refusal = install(BundleFile::open(on_stick_), request.again);
  } else {
    status_.refusal = status_.stick_trouble.empty() ? "no stick has an update" : status_.stick_trouble;
  }
  if (!status_.refusal.empty()) host::log(Level::Warning, "request rejected", {{"why", status_.refusal}});
  scan_sticks();  // the stick may have changed
  write_status();
}

std::string Updater::install(const std::expected<BundleFile, std::string>& file, bool again) {
  if (!file) return file.error();
  if (!status_.trouble.empty()) return status_.trouble;
  if (status_.trial) return update::wait_for_trial(status_.running.version);
  const auto hindrance = host::read_optional_file(options_.hindrance);
  if (!hindrance) return hindrance.error();
  if (*hindrance) return (*hindrance)->substr(0, (*hindrance)->find('\n'));
  status_.doing = "checking";
  write_status();
  const auto bundle = rauc_.info(file->path());
  std::string why = bundle ? update::refusal_reason(*bundle, status_.running, again) : bundle.error();
  if (why.empty()) why = write(*file, *bundle);
  status_.doing.clear();
  status_.progress.reset();
  return why;
}

/// Gives up the content of the slot to be written: restart_proven_slot() is no longer possible, and it is not
/// the next slot to start. If the slot is next afterwards, RAUC has written all of it.
std::string Updater::abandon_spare_slot() {
  const auto proven = load_proven(options_.state);
  const bool may_be_other = !proven || proven->slot == status_.running.other;
  if (may_be_other && !save(options_.state, update::ProvenSlot{})) return kNotKept;
  status_.stray.clear();
  const auto now = rauc_.status();
  if (!now) return now.error();
  const auto first = now->other_next ? rauc_.start_booted_next() : std::expected<void, std::string>{};
  return first ? "" : first.error();
}

std::string Updater::write(const BundleFile& file, const update::Bundle& bundle) {
  update::LastUpdate last_update{
      .stage = Stage::Installing, .version = bundle.version, .slot = status_.running.other, .boot = boot_};
  if (std::string why = abandon_spare_slot(); !why.empty()) return why;
  // Without this file the slot would not be on trial.
  if (!save(options_.state, last_update)) return kNotKept;
  status_.doing = "installing";
  status_.progress = 0;
  record_update(last_update);
  write_status();
  const auto installed = rauc_.install(file.path(), [this](int percent) {
    status_.progress = percent;
    write_status();
  });
  last_update.stage = installed ? Stage::Installed : Stage::Failed;
  last_update.why = installed ? "" : installed.error();
  if (!installed) {  // RAUC continues if its client died or took too long; status() waits for its end
    if (const auto ended = rauc_.status()) last_update = update::settle_update(last_update, *ended, boot_);
  }
  record_update(last_update);
  return last_update.why;
}

std::string Updater::restart() {
  status_.doing = "restarting";
  write_status();
  host::log(Level::Notice, "restarting the machine");
  const auto restarted = host::run_command({options_.systemctl, "reboot"}, kRestart);
  if (restarted) return "";
  status_.doing.clear();
  return "cannot restart the machine: " + restarted.error();
}

std::string Updater::restart_proven_slot() {
  if (status_.stray.empty()) return std::string(update::kNoStray);
  if (const auto chosen = rauc_.start_other_next(); !chosen) return chosen.error();
  return restart();
}

std::string Updater::keep_running_slot() {
  if (status_.stray.empty()) return std::string(update::kNoStray);
  if (!save(options_.state, update::ProvenSlot{status_.running.slot, status_.running.version}))
    return kNotKept;
  host::log(Level::Notice, "the running slot is to stay", {{"slot", status_.running.slot}});
  status_.stray.clear();
  return "";
}

void Updater::record_update(update::LastUpdate last_update) {
  host::log(
      last_update.stage == Stage::Left || last_update.stage == Stage::Failed ? Level::Error : Level::Notice,
      "an update",
      {{"version", last_update.version},
       {"slot", last_update.slot},
       {"stage", std::string(name_of(last_update.stage))},
       {"why", last_update.why}});
  save(options_.state, last_update);
  status_.last = std::move(last_update);
}

using host::Level;

constexpr std::chrono::seconds kSystemctlAnswer{30};
/// Interval of questions to systemd: for a slot on trial, and for a slot that lacks only its settings.
constexpr std::chrono::seconds kOnTrial{2}, kElse{10};

std::chrono::microseconds now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now().time_since_epoch());  // CLOCK_MONOTONIC, as systemd uses
}

update::Ready ready(const std::string& systemctl) {
  const auto said = host::output_of(
      {systemctl, "show", "--property=ActiveState,ActiveEnterTimestampMonotonic", "adit.service"},
      kSystemctlAnswer);
  return update::read_ready(said.out, now());
}

std::expected<void, std::string> restart(const std::string& systemctl) {
  host::log(Level::Error, "the slot on trial did not become healthy in time: restarting the machine");
  auto restarted = host::run_command({systemctl, "reboot"}, kSystemctlAnswer);
  if (restarted) return restarted;
  return std::unexpected("cannot restart the machine: " + restarted.error());
}

/// A failure to store this does not change the slot's state: a later start stores it. Only a trial or the
/// operator replaces an unreadable record.
void keep_proven(const UpdateOptions& options, const update::RunningSystem& running, bool trial) {
  const auto before = load_proven(options.state);
  if (!before && !trial) return;  // adit-update reports it
  const update::ProvenSlot proven = update::proven_now(before.value_or(update::ProvenSlot{}), running, trial);
  if (!before || proven != *before) save(options.state, proven);
}

std::expected<void, std::string> pass_trial(const UpdateOptions& options, update::LastUpdate last_update) {
  host::log(Level::Notice, "the update is healthy",
            {{"version", last_update.version}, {"slot", last_update.slot}});
  last_update.stage = update::Stage::Good;
  last_update.why.clear();  // of an end that adit-update has not settled
  if (!save(options.state, last_update)) return std::unexpected("cannot store the end of the trial");
  return {};
}

/// adit-update writes the status and ends RAUC's service.
void start_adit_update(const std::string& systemctl) {
  host::output_of({systemctl, "start", "--no-block", "adit-update.service"}, kSystemctlAnswer);
}

/// `adit-update good`: waits until the running slot is good and marks it so, or restarts the machine.
std::expected<void, std::string> watch_health(const UpdateOptions& options) {
  const Rauc rauc(options.rauc);
  auto running = ADIT_TRY(rauc.status());
  running.version = version_in(options.os_release);
  const auto last_update = load_last_update(options.state);
  if (!last_update) host::log(Level::Error, "a trial would not be noticed", {{"why", last_update.error()}});
  const bool trial = last_update && update::on_trial(*last_update, running, host::boot());
  const auto late_at = now() + options.within;
  while (true) {
    const auto health = update::classify(trial, ready(options.systemctl), now() >= late_at);
    if (health == update::Health::Restart) return restart(options.systemctl);
    if (health == update::Health::Good) break;
    std::this_thread::sleep_for(trial ? kOnTrial : kElse);
  }
  ADIT_TRY(rauc.mark_good());
  keep_proven(options, running, trial);
  auto passed = trial ? pass_trial(options, *last_update) : std::expected<void, std::string>{};
  if (passed) start_adit_update(options.systemctl);
  return passed;
}

}  // namespace
}  // namespace adit::applier

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<UpdateOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const UpdateOptions& options) {
        const auto done = options.good ? watch_health(options) : Updater(options).work();
        return host::log_failure(host::Level::Error, "cannot run", done) ? 0 : 1;
      });
}
