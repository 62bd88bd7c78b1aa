#include "spare/stick.hpp"

#include <algorithm>
#include <array>
#include <ctime>

#include "codec/nonce.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::spare {
namespace {

constexpr std::string_view kBegin = "adit-", kEnd = ".adit-spare";
constexpr std::size_t kLongest = 96, kLongestBox = 48;
constexpr const char* kTime = "%Y%m%dT%H%M%SZ";
constexpr std::size_t kTimeLetters = 16;

bool is_plain(char letter) {
  return icd::is_letter_or_digit(letter) || letter == '.';
}

std::string time_text(double at) {
  const auto seconds = static_cast<std::time_t>(at);
  std::tm parts{};
  std::array<char, kTimeLetters + 1> text{};
  if (at < 0 || at >= 253402300800 || gmtime_r(&seconds, &parts) == nullptr) return "";
  return {text.data(), std::strftime(text.data(), text.size(), kTime, &parts)};
}

std::optional<double> time_in(std::string_view text) {
  std::tm parts{};
  const std::string whole(text);
  const char* const end = strptime(whole.c_str(), kTime, &parts);
  if (whole.size() != kTimeLetters || end == nullptr || *end != '\0') return std::nullopt;
  const auto at = static_cast<double>(timegm(&parts));
  return time_text(at) == whole ? std::optional(at) : std::nullopt;
}

}  // namespace

std::string file_name(std::string_view box, double at) {
  std::string name(kBegin);
  for (const char each : box.substr(0, kLongestBox)) name += is_plain(each) ? each : '-';
  return name.append("-").append(time_text(at)).append(kEnd);
}

bool is_file_name(std::string_view name) {
  return name.size() > kEnd.size() && name.size() <= kLongest && name.ends_with(kEnd) &&
         !name.starts_with('.') &&
         std::ranges::all_of(name, [](char each) { return each >= ' ' && each <= '~' && each != '/'; });
}

ExportName named_for(std::string_view name) {
  if (!is_file_name(name) || !name.starts_with(kBegin)) return {};
  name.remove_prefix(kBegin.size());
  name.remove_suffix(std::min(kEnd.size(), name.size()));
  const std::size_t hyphen = name.rfind('-');
  if (hyphen == std::string_view::npos || hyphen == 0) return {};
  const auto at = time_in(name.substr(hyphen + 1));
  return at ? ExportName{.box = std::string(name.substr(0, hyphen)), .at = at} : ExportName{};
}

bool is_before(std::string_view left, std::string_view right) {
  const auto one = named_for(left).at, other = named_for(right).at;
  return one == other ? left < right : one > other;
}

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

static constexpr std::string_view kCommandWords[] = {"write",
                                                     "take"};  // in the order of StickRequest::Command
static constexpr auto& words_of(StickRequest::Command /*of*/) {
  return kCommandWords;
}

namespace {

using codec::member;

/// A name that cannot leave its directory.
constexpr codec::Form kName{is_file_name, "the name of an export"};

constexpr codec::Member kRequestMembers[] = {
    member<&StickRequest::nonce>("nonce").matching(codec::kNonce),
    member<&StickRequest::what>("what"),
    member<&StickRequest::name>("name").matching(kName),
};
constexpr codec::Member kStatusMembers[] = {
    member<&StickStatus::nonce>("nonce"),         member<&StickStatus::refusal>("refusal"),
    member<&StickStatus::doing>("doing"),         member<&StickStatus::written>("written"),
    member<&StickStatus::hindrance>("hindrance"), member<&StickStatus::unreadable>("unreadable"),
    member<&StickStatus::exports>("exports"),
};

}  // namespace

constexpr codec::Row StickRequest::kRow = codec::complete<StickRequest>({"", kRequestMembers});
constexpr codec::Row StickStatus::kRow = codec::complete<StickStatus>({"", kStatusMembers});

}  // namespace adit::spare
