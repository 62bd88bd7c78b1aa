#include "admin/takeover.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <compare>

#include "access/certificate.hpp"
#include "admin/kept_file.hpp"
#include "codec/row.hpp"
#include "forward/clocks.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "icd/try.hpp"
#include "ledger/ledger.hpp"
#include "settings/settings.hpp"
#include "settings/written.hpp"

namespace adit::admin {
namespace {

constexpr codec::Member kRestMembers[] = {
    codec::member<&Standby::code>("code"),         codec::member<&Standby::since>("since"),
    codec::member<&Standby::stamp>("stamp"),       codec::member<&Standby::told>("told"),
    codec::member<&Standby::expected>("expected"),
};
constexpr codec::Member kTakenMembers[] = {
    codec::member<&TakeoverRecord::box>("box"),
    codec::member<&TakeoverRecord::at>("at"),
    codec::member<&TakeoverRecord::rest_count>("rest_count"),
};
constexpr codec::Member kFileMembers[] = {
    codec::member<&SpareFile::box>("box"),
    codec::member<&SpareFile::rest>("rest"),
    codec::member<&SpareFile::rest_count>("rest_count"),
    codec::member<&SpareFile::taken>("taken"),
};

}  // namespace

constexpr codec::Row Standby::kRow = codec::complete<Standby>({"", kRestMembers});
constexpr codec::Row TakeoverRecord::kRow = codec::complete<TakeoverRecord>({"", kTakenMembers});
constexpr codec::Row SpareFile::kRow = codec::complete<SpareFile>({"", kFileMembers});

std::expected<SpareFile, std::string> SpareFile::read(const std::string& state_folder) {
  std::string unread;
  return read(state_folder, unread);
}

std::expected<SpareFile, std::string> SpareFile::read(const std::string& state_folder, std::string& unread) {
  return read_kept_file(state_folder + '/' + kName, &codec::read_file<SpareFile>, unread);
}

std::expected<void, std::string> SpareFile::write(const std::string& state_folder) const {
  return host::write_kept(state_folder + '/' + kName, codec::write_file(*this));
}

std::string SpareFile::refusal_reason(const spare::ExportInfo& about) const {
  if (about.box == box) return "this box made the export itself: end the standby if no spare took over";
  const auto before = std::ranges::find(taken, about.box, &TakeoverRecord::box);
  if (before == taken.end()) return "";
  // Prefers the counts, because that box's clock may have been set back in between.
  const bool are_counted = about.rest_count && before->rest_count;
  const auto order = are_counted ? *about.rest_count <=> *before->rest_count : about.at <=> before->at;
  if (order > 0) return "";
  return order == 0 ? "this box already took over from this export"
                    : "this box already took over from a later export of the same box";
}

namespace {

/// Seconds by which this box's stamps (`stamp` now) are ahead of the first box's. `wall`: this box's time of
/// day. The time since the first box's standby comes from both times of day. If they cannot be compared, it
/// counts as 0, because a long silence would look like a new run.
double stamp_offset(const spare::ExportInfo& about, double stamp, double wall) {
  const double since = std::max(0.0, wall - about.told_at.value_or(wall));
  return stamp - since - about.stamp;
}

/// The first box's ports (`taken`) at all addresses of the team interface, or else at the ones of `here`.
std::vector<settings::Address> listen_here(const settings::Team& here,
                                           const std::vector<settings::Address>& taken) {
  std::vector<settings::Address> own = here.listen, all;
  for (const settings::Address& each : taken) {
    if (!here.interface.empty()) own = {{.address = each.address.contains(':') ? "::" : "0.0.0.0"}};
    for (settings::Address at : own) {
      at.port = each.port;
      if (std::ranges::find(all, at) == all.end()) all.push_back(std::move(at));
    }
  }
  return all;
}

/// Preserves settings of the machine, which may differ from the first box's.
void keep_hardware(settings::Settings& here, settings::Settings& taken) {
  taken.team.listen = listen_here(here.team, taken.team.listen);
  taken.command_post.interface = std::move(here.command_post.interface);
  taken.team.interface = std::move(here.team.interface);
  taken.panel = std::move(here.panel);
}

}  // namespace

std::expected<void, std::string> Takeover::begin(const std::string& content) {
  return host::write_file(marker_path(), content, host::kOursAlone);
}

std::expected<bool, std::string> Takeover::finish(const loop::Loop& loop) {
  const auto file = host::slurp(marker_path(), spare::kLargestExport);
  if (!file && file.error() == ENOENT) return false;
  if (!file) return std::unexpected(unread_ = host::path_error(marker_path(), file.error()));
  const auto content = spare::read(file->text);
  if (!content) return std::unexpected(marker_path() + ": " + content.error());
  ADIT_TRY(apply(*content, loop));
  ADIT_TRY(host::remove_file(marker_path()));
  host::log(host::Level::Notice, "this box took over from another",
            {{"from", content->about.name}, {"reports", std::to_string(content->about.reports)}});
  return true;
}

/// Every step can be repeated. The last step records the first box, which finishes the takeover.
std::expected<void, std::string> Takeover::apply(const spare::Content& content, const loop::Loop& loop) {
  forward::StampFloor stamps(state_);
  const auto kept = ADIT_TRY(stamps.read());
  const double least = std::ceil(std::max(content.about.stamps, kept.least));  // the stored form
  const dispatch::Handover handover{
      .expected = content.about.expected,
      .stamp = std::max(loop.stamp_now(), least),
      .ahead = stamp_offset(content.about, std::max(loop.stamp_now(), least), loop.wall_now())};
  if (auto taken = apply_ledger(content, handover, kept.ledger); !taken) return taken;
  forward::StampFloor::StoredFloor next = kept;
  next.floor = std::max(kept.floor, least);
  next.least = least;
  stamps.write(next);
  const auto written = stamps.read();
  if (!written || written->least < least) return std::unexpected("cannot store the first box's time stamps");
  if (auto taken = apply_settings(content); !taken) return taken;
  return note(content.about);
}

std::expected<settings::SavedSettings, std::string> Takeover::check(const spare::Content& content) const {
  auto saved = settings::parse_saved(content.settings);
  if (!saved)
    return std::unexpected("this box cannot use the export's settings: " +
                           settings::sentence_of(saved.error()));
  if (!ledger::Ledger::is_copy(content.ledger))
    return std::unexpected("this box cannot use the export's ledger: it is no copy of a ledger");
  if (const auto pem = access::read_pem(content.certificate); !content.certificate.empty() && !pem)
    return std::unexpected("this box cannot use the export's certificate: " + pem.error());
  return *std::move(saved);
}

std::expected<void, std::string> Takeover::abandon() {
  return host::remove_file(marker_path());
}

std::expected<void, std::string> Takeover::apply_ledger(const spare::Content& content,
                                                        const dispatch::Handover& handover,
                                                        const ledger::LedgerFacts& known) {
  auto here = ledger::Ledger::open(state_, known, memory_);
  if (!here) return std::unexpected("this box's ledger: " + here.error().what);
  if (!here->damage().empty()) host::log(host::Level::Error, here->damage());
  if (auto taken = here->take_over(content.ledger, handover); !taken)
    return std::unexpected(std::move(taken.error().what));
  return {};
}

std::expected<void, std::string> Takeover::apply_settings(const spare::Content& content) {
  auto saved = settings::parse_saved(content.settings);
  if (!saved) return std::unexpected("the first box's settings: " + settings::sentence_of(saved.error()));
  auto here = ADIT_TRY(store_.load());
  if (!store_.unread().empty()) return std::unexpected(store_.unread());
  keep_hardware(here.settings, saved->settings);
  if (const auto both = settings::parse(settings::file_of(saved->settings)); !both)
    return std::unexpected("the two boxes' settings do not fit: " + settings::sentence_of(both.error()));
  for (const std::string& name : token_names(saved->settings)) {
    const auto found = content.tokens.find(name);
    const auto token = found == content.tokens.end() ? std::nullopt : std::optional(found->second);
    if (auto kept = store_.save_token(name, token); !kept) return kept;
  }
  if (!content.certificate.empty())
    ADIT_TRY(
        host::write_file(state_ + '/' + access::kCertificateFile, content.certificate, host::kOursAlone));
  return store_.save(saved->settings);
}

std::expected<void, std::string> Takeover::note(const spare::ExportInfo& about) {
  auto file = ADIT_TRY(SpareFile::read(state_));
  file.rest.reset();
  std::erase_if(file.taken, [&about](const TakeoverRecord& each) { return each.box == about.box; });
  file.taken.push_back({.box = about.box, .at = about.at, .rest_count = about.rest_count});
  return file.write(state_);
}

}  // namespace adit::admin
