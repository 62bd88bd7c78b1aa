#include "spare/stick.hpp"

#include <algorithm>

#include "codec/nonce.hpp"
#include "icd/sentence.hpp"
#include "spare/file_name.hpp"

namespace adit::spare {

std::expected<Medium, std::string> medium_for(std::span<const Medium> media, std::uint64_t size) {
  if (media.empty()) return std::unexpected("there is no stick in the box");
  if (std::ranges::any_of(media, [&media](const Medium& each) { return each.disk != media.front().disk; }))
    return std::unexpected("there is more than one stick in the box: leave only the one for the export");
  const Medium* best = nullptr;
  for (const Medium& each : media) {
    if (each.is_mounted && (best == nullptr || each.room > best->room)) best = &each;
  }
  if (best == nullptr) return std::unexpected(kUnknownFileSystem);
  if (best->is_write_protected) return std::unexpected("the stick is write-protected");
  if (best->room < size)
    return std::unexpected(
        icd::sentence("the stick has room for ", best->room, " bytes, but the export has ", size));
  return *best;
}

static constexpr std::string_view kWhatWords[] = {"write", "take"};  // in the order of StickRequest::What
static constexpr auto& words_of(StickRequest::What /*of*/) {
  return kWhatWords;
}

namespace {

using codec::member;

/// A name that cannot leave its directory.
constexpr char kExpectedName[] = "expected the name of an export";

constexpr codec::Member kRequestMembers[] = {
    member<&StickRequest::nonce>("nonce").as(codec::kNonce),
    member<&StickRequest::what>("what"),
    member<&StickRequest::name>("name").as(codec::kCheckedText<is_file_name, kExpectedName>),
};
constexpr codec::Member kStatusMembers[] = {
    member<&StickStatus::nonce>("nonce"),         member<&StickStatus::refusal>("refusal"),
    member<&StickStatus::doing>("doing"),         member<&StickStatus::written>("written"),
    member<&StickStatus::hindrance>("hindrance"), member<&StickStatus::unreadable>("unreadable"),
    member<&StickStatus::exports>("exports"),
};

}  // namespace

constexpr codec::Row StickRequest::kRow = {"", kRequestMembers};
constexpr codec::Row StickStatus::kRow = {"", kStatusMembers};

}  // namespace adit::spare
