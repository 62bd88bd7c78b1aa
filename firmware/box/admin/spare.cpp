#include "admin/spare.hpp"

#include <unistd.h>

#include <cmath>
#include <memory>
#include <utility>

#include "host/files.hpp"
#include "host/log.hpp"
#include "host/random.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "spare/sealed.hpp"
#include "spare/stick.hpp"

namespace adit::admin {
namespace {

using icd::Status;

constexpr const char* kNotHere = "USB sticks are not available: adit-spare does not run";

/// The action to show until adit-spare reports its own.
const char* pending_action(spare::StickRequest::Command what) {
  return what == spare::StickRequest::Command::Write ? "writing" : "reading";
}

/// Reads from adit-spare's directory, in memory.
std::expected<std::string, std::string> read_from_stick(const std::string& path) {
  auto file = host::slurp(path, spare::kLargestExport);
  if (!file)
    return std::unexpected("cannot read the export from the stick: " + host::path_error(path, file.error()));
  return std::move(file->text);
}

}  // namespace

SpareStick::SpareStick(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder,
                       Taken taken)
    : loop_(loop),
      adit_spare_(loop, "adit-spare", state_folder, status_folder, kTakenUpWithin),
      taken_(std::move(taken)),
      timer_(loop.timer([this] { poll(); })) {}

std::optional<api::StickRow> SpareStick::view() const {
  if (!adit_spare_.runs_here()) return std::nullopt;
  const auto now = adit_spare_.status();
  api::StickRow row{.hindrance = now ? now->hindrance : adit_spare_.status_error(),
                    .unreadable = now ? now->unreadable : "",
                    .doing = now ? now->doing : "",
                    .refusal = refusal_,
                    .written = now && !asked_ ? now->written : "",
                    .exports = {}};
  if (asked_ && row.doing.empty()) row.doing = pending_action(*asked_);
  if (!now && !adit_spare_.is_starting()) row.unreadable = adit_spare_.status_error();
  if (!now) return row;
  for (const std::string& name : now->exports) {
    spare::ExportName named = spare::named_for(name);
    row.exports.push_back({.name = name, .box = std::move(named.box), .at = named.at});
  }
  return row;
}

icd::Checked<void> SpareStick::check_free() const {
  const auto now = view();
  if (!now) return icd::conflict(kNotHere);
  if (!adit_spare_.status()) return adit_spare_.refuse();
  if (now->doing.empty()) return {};
  return icd::conflict("the box is already ", now->doing, " an export: wait");
}

icd::Checked<void> SpareStick::write(const std::string& name, const std::string& file) {
  ADIT_TRY(check_free());
  if (const auto now = view(); now && !now->hindrance.empty()) return icd::conflict(now->hindrance);
  const auto left = host::write_file(stick_request_file(), file, host::kOursAlone);
  if (!left) return icd::refuse(Status::ServiceUnavailable, left.error());
  return ask(Command::Write, name);
}

icd::Checked<void> SpareStick::request_import(const std::string& name) {
  if (!spare::is_file_name(name))
    return icd::refuse(Status::UnprocessableEntity, "name: expected the name of an export on the stick");
  ADIT_TRY(check_free());
  return ask(Command::Take, name);
}

icd::Checked<void> SpareStick::ask(Command what, const std::string& name) {
  const spare::StickRequest request{.nonce = host::draw_nonce(), .what = what, .name = name};
  if (const auto asked = adit_spare_.ask(spare::kStickRequestFile, request); !asked) {
    unlink(stick_request_file().c_str());
    return icd::refuse(Status::ServiceUnavailable, "cannot request it from adit-spare: " + asked.error());
  }
  asked_ = what;
  refusal_.clear();
  timer_.call_at(loop_.now() + kLook);
  return {};
}

void SpareStick::poll() {
  if (!asked_) return;
  if (adit_spare_.check()) {
    unlink(stick_request_file().c_str());
    asked_.reset();
    refusal_ = adit_spare_.trouble();
    return;
  }
  const auto now = adit_spare_.status();
  if (now && !adit_spare_.is_pending() && now->doing.empty()) return finish(*now);
  timer_.call_at(loop_.now() + kLook);
}

void SpareStick::finish(const spare::StickStatus& status) {
  const Command what = *std::exchange(asked_, std::nullopt);
  refusal_ = status.refusal;
  if (!refusal_.empty() || what == Command::Write) return;
  auto file = read_from_stick(adit_spare_.directory() + '/' + spare::kFromStickFile);
  if (!file) {
    refusal_ = std::move(file.error());
    return;
  }
  taken_(*std::move(file));
}

Spare::Spare(loop::Loop& loop, loop::Workers& workers, Takeover& takeover, std::string state_folder,
             const std::string& status_folder, const std::string& stuck, Callbacks callbacks)
    : loop_(loop),
      workers_(workers),
      takeover_(takeover),
      state_(std::move(state_folder)),
      stick_(loop, state_, status_folder, [this](std::string file) { on_stick_export(std::move(file)); }),
      stuck_(stuck),
      callbacks_(std::move(callbacks)),
      restart_(loop.timer([this] { callbacks_.restart(); })) {
  auto file = SpareFile::read(state_, unread_);
  const std::string unknown = file ? "" : file.error();
  if (file) file_ = *std::move(file);
  if (is_stuck()) {
    standby_ = stuck_;
  } else if (!unknown.empty()) {
    standby_ = "it is not known whether a spare took over: " + unknown;
  } else if (file_.rest) {
    standby_ = "its spare takes over";
  }
  if (!standby_.empty()) host::log(host::Level::Warning, "this box is on standby", {{"why", standby_}});
}

void Spare::on_end(const std::optional<icd::RunStatus>& expected) {
  if (!goes_on_standby_ || !expected) return;
  SpareFile next = file_;
  next.rest->expected = expected;
  host::log_failure(host::Level::Warning, "cannot store the run's status for the spare", keep(next));
}

bool Spare::is_current_export(const std::string& file) const {
  return file_.rest && spare::named_for(file).at == std::floor(file_.rest->since);
}

icd::Checked<void> Spare::keep(const SpareFile& next) {
  if (auto written = next.write(state_); !written)
    return icd::refuse(Status::ServiceUnavailable, written.error());
  file_ = next;
  return {};
}

api::SpareView Spare::state() const {
  api::SpareView view;
  view.standby = !standby_.empty();
  view.why = standby_;
  view.asks_code = sealed_ != nullptr;
  view.takes_over = takes_over_;
  view.stick = stick_.view();
  // the last export of an earlier standby does not count
  if (view.stick && !is_current_export(view.stick->written)) view.stick->written.clear();
  if (file_.rest) view.since = file_.rest->since;
  if (view.standby && file_.rest) view.code = spare::code_text(file_.rest->code);
  if (!opened_) return view;
  const spare::ExportInfo& about = opened_->content.about;
  view.taken_in = {.name = about.name,
                   .version = about.version,
                   .at = about.at,
                   .reports = about.reports,
                   .open = about.open,
                   .post = about.post,
                   .run = about.run,
                   .port = opened_->settings.settings.team.listen.front().port,
                   .left_out = opened_->settings.passed_over};
  return view;
}

icd::Checked<void> Spare::enter_standby() {
  if (!standby_.empty() || goes_on_standby_) return {};
  if (takes_over_) return icd::conflict("this box is taking over just now");
  SpareFile next = file_;
  if (next.box.empty()) next.box = host::random_digits<8>();
  const double now = loop_.wall_now();
  next.rest = {.code = spare::draw_code(host::random_bytes<spare::kCodeDigits>()),
               .since = now,
               .stamp = loop_.stamp_now(),
               .told = callbacks_.is_time_set() ? std::optional(now) : std::nullopt};
  next.rest_count = next.rest_count.value_or(0) + 1;
  if (auto kept = keep(next); !kept) return kept;
  goes_on_standby_ = true;
  host::log(host::Level::Notice, "this box goes on standby, so that a spare takes over");
  restart_.call_at(loop_.now());
  return {};
}

icd::Checked<void> Spare::resume() {
  if (standby_.empty()) return icd::conflict("this box is not on standby");
  if (!is_stuck()) {
    std::string unread;
    SpareFile next = SpareFile::read(state_, unread).value_or(SpareFile());  // a damaged file is replaced
    if (!unread.empty()) return icd::refuse(Status::ServiceUnavailable, unread);
    next.rest.reset();
    if (auto kept = keep(next); !kept) return kept;
    host::log(host::Level::Notice, "standby ended: no spare took over");
  }
  restart_.call_at(loop_.now());
  return {};
}

void Spare::export_to(Sealed done) {
  seal([done = std::move(done)](icd::Checked<std::string> file, const std::string&) {
    done(std::move(file));
  });
}

void Spare::export_to_stick(Done done) {
  seal([this, done = std::move(done)](const icd::Checked<std::string>& file, const std::string& name) {
    if (!file) return done(std::unexpected(file.error()));
    done(stick_.write(spare::file_name(name, file_.rest ? file_.rest->since : 0), *file));
  });
}

void Spare::seal(const SealCallback& done) {
  const auto refused = [&done](Status status, const std::string& why) { done(icd::refuse(status, why), ""); };
  if (!file_.rest || standby_.empty() || is_stuck())
    return refused(Status::Conflict, "this box is not on standby: only a box on standby can be exported");
  auto content = callbacks_.content();
  if (!content) return refused(Status::ServiceUnavailable, content.error());
  content->about.box = file_.box;
  content->about.at = file_.rest->since;
  content->about.stamp = file_.rest->stamp.value_or(loop_.stamp_now());
  content->about.rest_count = file_.rest_count;
  content->about.told_at = file_.rest->told;
  content->about.expected = file_.rest->expected;
  auto text = std::make_shared<std::string>(spare::write(*content));
  if (text->size() > spare::kLargestExport - spare::kSealing)
    return refused(Status::Conflict, "the ledger is larger than an export may be");
  auto sealed = std::make_shared<std::expected<std::string, std::string>>(
      std::unexpected("the export could not be sealed"));
  const spare::Seed seed{.salt = host::random_bytes<16>(), .nonce = host::random_bytes<24>()};
  workers_.submit(
      loop::Urgency::CanWait,
      [text, sealed, seed, code = file_.rest->code] { *sealed = spare::seal(*text, code, seed); },
      [sealed, done, name = content->about.name] {
        if (!*sealed) return done(icd::refuse(Status::ServiceUnavailable, sealed->error()), name);
        done(std::move(**sealed), name);
      });
}

icd::Checked<void> Spare::import_from_stick(const std::string& name) {
  if (takes_over_) return icd::conflict("this box is taking over just now");
  return stick_.request_import(name);
}

/// Runs the checks of an upload.
void Spare::on_stick_export(std::string file) {
  host::log_failure(host::Level::Warning, "export from the stick rejected", import_file(std::move(file)));
}

icd::Checked<void> Spare::import_file(std::string file) {
  if (takes_over_) return icd::conflict("this box is taking over just now");
  opened_.reset();
  sealed_ = std::make_shared<const std::string>(std::move(file));
  return {};
}

void Spare::open(const std::string& code, Done done) {
  const auto typed = spare::code_in(code);
  if (!typed) return done(icd::unprocessable("code: expected ", spare::kCodeDigits, " digits"));
  if (!sealed_) return done(icd::conflict("there is no export to open: import one first"));
  auto text = std::make_shared<std::expected<std::string, std::string>>(
      std::unexpected("the export could not be opened"));
  workers_.submit(
      loop::Urgency::CanWait,
      [sealed = sealed_, text, code = *typed] { *text = spare::unseal(*sealed, code); },
      [this, sealed = sealed_, text, done = std::move(done)] {
        if (sealed != sealed_) return done(icd::conflict("another export was imported meanwhile"));
        auto checked = check(*text);
        if (!checked) return done(std::unexpected(std::move(checked.error())));
        opened_ = *std::move(checked);
        sealed_.reset();
        done({});
      });
}

/// After a wrong code, the user may try again.
icd::Checked<Spare::OpenedExport> Spare::check(const std::expected<std::string, std::string>& text) const {
  if (!text) return icd::refuse(Status::UnprocessableEntity, text.error());
  auto content = spare::read(*text);
  if (!content) return icd::refuse(Status::UnprocessableEntity, content.error());
  if (std::string why = file_.refusal_reason(content->about); !why.empty()) return icd::conflict(why);
  auto settings = takeover_.check(*content);
  if (!settings) return icd::refuse(Status::UnprocessableEntity, settings.error());
  return OpenedExport{*std::move(content), *std::move(settings)};
}

/// Also abandons a takeover that cannot be finished.
icd::Checked<void> Spare::forget() {
  if (takes_over_) return icd::conflict("this box is taking over just now");
  if (is_stuck()) {
    if (auto done = takeover_.abandon(); !done) return icd::refuse(Status::ServiceUnavailable, done.error());
    restart_.call_at(loop_.now());
  }
  opened_.reset();
  sealed_.reset();
  return {};
}

icd::Checked<void> Spare::take_over() {
  if (takes_over_) return {};
  if (!opened_) return icd::conflict("no export is open: import and open one first");
  spare::Content content = opened_->content;
  if (!callbacks_.is_time_set()) content.about.told_at.reset();  // an unset time of day cannot be compared
  if (auto begun = takeover_.begin(spare::write(content)); !begun)
    return icd::refuse(Status::ServiceUnavailable, begun.error());
  takes_over_ = true;
  restart_.call_at(loop_.now());
  return {};
}

}  // namespace adit::admin
