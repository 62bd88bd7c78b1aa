#include "admin/spare_stick.hpp"

#include <unistd.h>

#include <utility>

#include "admin/refuse.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "spare/file_name.hpp"
#include "spare/sealed.hpp"

namespace adit::admin {
namespace {

using icd::Status;

constexpr const char* kNotHere = "USB sticks are not available: adit-spare does not run";

/// The action to show until adit-spare reports its own.
const char* doing_of(spare::StickRequest::What what) {
  return what == spare::StickRequest::What::Write ? "writing" : "reading";
}

/// Reads from adit-spare's directory, in memory.
std::expected<std::string, std::string> read_from_stick(const std::string& path) {
  auto file = host::slurp(path, spare::kLargestExport);
  if (!file)
    return std::unexpected("cannot read the export from the stick: " + host::trouble(path, file.error()));
  return std::move(file->text);
}

}  // namespace

SpareStick::SpareStick(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder,
                       Taken taken)
    : loop_(loop),
      adit_spare_(loop, "adit-spare", state_folder, status_folder, kTakenUpWithin),
      taken_(std::move(taken)),
      timer_(loop.timer([this] { look(); })) {}

std::optional<api::StickRow> SpareStick::view() const {
  if (!adit_spare_.runs_here()) return std::nullopt;
  const auto now = adit_spare_.status();
  api::StickRow row{.hindrance = now ? now->hindrance : adit_spare_.why(),
                    .unreadable = now ? now->unreadable : "",
                    .doing = now ? now->doing : "",
                    .refusal = refusal_,
                    .written = now && !asked_ ? now->written : "",
                    .exports = {}};
  if (asked_ && row.doing.empty()) row.doing = doing_of(*asked_);
  if (!now && !adit_spare_.is_starting()) row.unreadable = adit_spare_.why();
  if (!now) return row;
  for (const std::string& name : now->exports) {
    spare::NamedFor named = spare::named_for(name);
    row.exports.push_back({.name = name, .box = std::move(named.box), .at = named.at});
  }
  return row;
}

icd::Checked<void> SpareStick::check_free() const {
  const auto now = view();
  if (!now) return conflict(kNotHere);
  if (!adit_spare_.status()) return conflict(adit_spare_.why());
  if (now->doing.empty()) return {};
  return conflict(icd::sentence("the box is already ", now->doing, " an export: wait"));
}

icd::Checked<void> SpareStick::write(const std::string& name, const std::string& file) {
  ADIT_TRY(check_free());
  if (const auto now = view(); now && !now->hindrance.empty()) return conflict(now->hindrance);
  const auto left = host::write_file(for_stick(), file, host::kOursAlone);
  if (!left) return refuse(Status::ServiceUnavailable, left.error());
  return ask(What::Write, name);
}

icd::Checked<void> SpareStick::take(const std::string& name) {
  if (!spare::is_file_name(name))
    return refuse(Status::UnprocessableEntity, "name: expected the name of an export on the stick");
  ADIT_TRY(check_free());
  return ask(What::Take, name);
}

icd::Checked<void> SpareStick::ask(What what, const std::string& name) {
  const spare::StickRequest request{.nonce = host::draw_nonce(), .what = what, .name = name};
  if (const auto asked = adit_spare_.ask(spare::kStickRequestFile, request); !asked) {
    unlink(for_stick().c_str());
    return refuse(Status::ServiceUnavailable, "cannot request it from adit-spare: " + asked.error());
  }
  asked_ = what;
  refusal_.clear();
  timer_.call_at(loop_.now() + kLook);
  return {};
}

void SpareStick::look() {
  if (!asked_) return;
  if (adit_spare_.check()) {
    unlink(for_stick().c_str());
    asked_.reset();
    refusal_ = adit_spare_.trouble();
    return;
  }
  const auto now = adit_spare_.status();
  if (now && !adit_spare_.waits() && now->doing.empty()) return finish(*now);
  timer_.call_at(loop_.now() + kLook);
}

void SpareStick::finish(const spare::StickStatus& status) {
  const What what = *std::exchange(asked_, std::nullopt);
  refusal_ = status.refusal;
  if (!refusal_.empty() || what == What::Write) return;
  auto file = read_from_stick(adit_spare_.directory() + '/' + spare::kFromStickFile);
  if (!file) {
    refusal_ = std::move(file.error());
    return;
  }
  taken_(*std::move(file));
}

}  // namespace adit::admin
