#include "admin/spare_stick.hpp"

#include <unistd.h>

#include <utility>

#include "admin/nonce.hpp"
#include "admin/refuse.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "spare/file_name.hpp"
#include "spare/sealed.hpp"

namespace adit::admin {
namespace {

using icd::Status;

constexpr const char* kNotHere = "USB sticks are not available: adit-spare does not run";

icd::Refusal conflict(std::string sentence) {
  return {Status::Conflict, std::move(sentence)};
}

/// What is said to be done before adit-spare says so itself.
const char* doing_of(spare::StickRequest::What what) {
  return what == spare::StickRequest::What::Write ? "writing" : "reading";
}

/// Why nothing can be asked for as it stands.
std::optional<icd::Refusal> hindrance_in(const std::optional<api::StickRow>& now) {
  if (!now) return conflict(kNotHere);
  if (now->doing.empty()) return std::nullopt;
  return conflict(icd::sentence("the box is already ", now->doing, " an export: wait"));
}

/// Of adit-spare's folder, in memory.
std::expected<std::string, std::string> read_from_stick(const std::string& path) {
  auto file = host::slurp(path, spare::kLargestExport);
  if (!file)
    return std::unexpected("cannot read the export from the stick: " + host::trouble(path, file.error()));
  return std::move(file->text);
}

}  // namespace

SpareStick::SpareStick(loop::Loop& loop, std::string state_folder, std::string status_folder, Taken taken)
    : loop_(loop),
      state_(std::move(state_folder)),
      status_(std::move(status_folder)),
      taken_(std::move(taken)),
      timer_(loop.timer([this] { look(); })) {}

std::expected<spare::StickStatus, std::string> SpareStick::status() const {
  const auto text = host::read_file(status_ + '/' + spare::kStickStatusFile);
  if (!text) return std::unexpected(text.error());
  return spare::read_message<spare::StickStatus>(*text);
}

std::optional<api::StickRow> SpareStick::view() const {
  auto now = status();
  if (!now) return std::nullopt;
  api::StickRow row{.hindrance = std::move(now->hindrance),
                    .doing = asked_ && now->doing.empty() ? doing_of(asked_->request.what) : now->doing,
                    .refusal = refusal_,
                    .written = asked_ ? "" : std::move(now->written),
                    .exports = {}};
  for (std::string& name : now->exports) {
    spare::NamedFor named = spare::named_for(name);
    row.exports.push_back({.name = std::move(name), .box = std::move(named.box), .at = named.at});
  }
  return row;
}

std::optional<icd::Refusal> SpareStick::hindrance() const {
  return hindrance_in(view());
}

std::optional<icd::Refusal> SpareStick::hindrance_to_write() const {
  const auto now = view();
  if (auto why = hindrance_in(now)) return why;
  return now->hindrance.empty() ? std::nullopt : std::optional(conflict(now->hindrance));
}

icd::Checked<void> SpareStick::write(const std::string& name, const std::string& file) {
  if (auto why = hindrance_to_write()) return std::unexpected(std::move(*why));
  const auto left = host::write_file(state_ + '/' + spare::kForStickFile, file, host::kOursAlone);
  if (!left) return refuse(Status::ServiceUnavailable, left.error());
  return ask(What::Write, name);
}

icd::Checked<void> SpareStick::take(const std::string& name) {
  if (!spare::is_file_name(name))
    return refuse(Status::UnprocessableEntity, "name: expected the name of an export on the stick");
  if (auto why = hindrance()) return std::unexpected(std::move(*why));
  return ask(What::Take, name);
}

icd::Checked<void> SpareStick::ask(What what, const std::string& name) {
  spare::StickRequest request{.nonce = draw_nonce(), .what = what, .name = name};
  const auto asked = host::write_file(state_ + '/' + spare::kStickRequestFile, spare::write_message(request),
                                      host::kOursAlone);
  if (!asked) {
    forget();
    return refuse(Status::ServiceUnavailable, "cannot request it from adit-spare: " + asked.error());
  }
  asked_ = Asked{.request = std::move(request), .at = loop_.now()};
  refusal_.clear();
  timer_.call_at(loop_.now() + kLook);
  return {};
}

void SpareStick::look() {
  if (!asked_) return;
  const auto now = status();
  const bool is_taken_up = now && now->nonce == asked_->request.nonce;
  if (is_taken_up && now->doing.empty()) return finish(*now);
  if (is_taken_up || loop_.now() < asked_->at + kTakenUpWithin) return timer_.call_at(loop_.now() + kLook);
  forget();
  asked_.reset();
  refusal_ = "adit-spare did not read the request: see journalctl -u adit-spare";
  host::log(host::Level::Error, "adit-spare did not read the request for an export");
}

void SpareStick::finish(const spare::StickStatus& status) {
  const What what = std::exchange(asked_, std::nullopt)->request.what;
  refusal_ = status.refusal;
  if (!refusal_.empty() || what == What::Write) return;
  auto file = read_from_stick(status_ + '/' + spare::kFromStickFile);
  if (!file) {
    refusal_ = std::move(file.error());
    return;
  }
  taken_(*std::move(file));
}

/// It is not to be done any more, where it has not been begun.
void SpareStick::forget() {
  unlink((state_ + '/' + spare::kStickRequestFile).c_str());
  unlink((state_ + '/' + spare::kForStickFile).c_str());
}

}  // namespace adit::admin
