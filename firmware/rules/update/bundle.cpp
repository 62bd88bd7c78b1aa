#include "update/bundle.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::update {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kLetters = "0123456789-abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

/// Digits without leading zeros.
bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kDigits) == std::string_view::npos &&
         (text.size() == 1 || text.front() != '0');
}

std::optional<std::uint64_t> number_in(std::string_view text) {
  return is_number(text) ? icd::number_in<std::uint64_t>(text) : std::nullopt;
}

std::vector<std::string_view> pieces_of(std::string_view text) {
  std::vector<std::string_view> pieces;
  for (std::size_t from = 0;;) {
    const std::size_t dot = text.find('.', from);
    pieces.push_back(text.substr(from, dot - from));
    if (dot == std::string_view::npos) return pieces;
    from = dot + 1;
  }
}

bool is_identifier(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kLetters) == std::string_view::npos;
}

/// "rc" or "1". Numbers have no leading zeros, so equal identifiers are written alike.
bool is_pre_release(std::string_view text) {
  const bool digits = text.find_first_not_of(kDigits) == std::string_view::npos;
  return is_identifier(text) && (!digits || is_number(text));
}

/// Numbers by value, words by ASCII, numbers before words.
std::strong_ordering compare(const std::string& left, const std::string& right) {
  const bool numbers[] = {is_number(left), is_number(right)};
  if (numbers[0] != numbers[1])
    return numbers[0] ? std::strong_ordering::less : std::strong_ordering::greater;
  if (numbers[0] && left.size() != right.size()) return left.size() <=> right.size();
  return left <=> right;
}

}  // namespace

std::optional<Version> Version::parse(std::string_view text) {
  if (text.size() > kLongest) return std::nullopt;
  const std::size_t plus = text.find('+');
  if (plus != std::string_view::npos && !std::ranges::all_of(pieces_of(text.substr(plus + 1)), is_identifier))
    return std::nullopt;
  const std::string_view rest = text.substr(0, plus);
  const std::size_t dash = rest.find('-');
  Version version;
  for (const std::string_view piece : pieces_of(rest.substr(0, dash))) {
    const auto number = number_in(piece);
    if (!number) return std::nullopt;
    version.release_.push_back(*number);
  }
  if (version.release_.size() != 3) return std::nullopt;
  if (dash == std::string_view::npos) return version;
  for (const std::string_view piece : pieces_of(rest.substr(dash + 1))) {
    if (!is_pre_release(piece)) return std::nullopt;
    version.pre_release_.emplace_back(piece);
  }
  return version;
}

std::strong_ordering operator<=>(const Version& left, const Version& right) {
  if (const auto order = left.release_ <=> right.release_; order != 0) return order;
  if (left.pre_release_.empty() != right.pre_release_.empty())
    return left.pre_release_.empty() ? std::strong_ordering::greater : std::strong_ordering::less;
  return std::lexicographical_compare_three_way(left.pre_release_.begin(), left.pre_release_.end(),
                                                right.pre_release_.begin(), right.pre_release_.end(),
                                                compare);
}

namespace {

constexpr std::string_view kBegin = "adit-", kEnd = ".raucb";

using codec::Field;
using codec::Value;

constexpr std::size_t kLongestFault = 300;
constexpr std::string_view kLastError = "LastError: ";
/// Message of RAUC's service (RAUC 1.8, src/service.c) while it installs or marks.
constexpr std::string_view kBusy = "already processing a different method";
/// RAUC's words (RAUC 1.8, src/bundle.c) and GLib's for what an operator can mend; the first that fit count.
constexpr std::string_view kDamaged = "the update's file is damaged: download or copy it again";
constexpr std::pair<std::string_view, std::string_view> kMeanings[] = {
    {"Verify error", "the update is signed by a key that this box does not accept"},
    {"signature verification failed", kDamaged},
    {"Invalid bundle format: Signature size", kDamaged},
    {"Error reading from file", kDamaged},
};

/// Reads a slot of RAUC, an object with one member, the slot's name. `next`: the slot to start next.
void take_slot(const Value& slot, const std::string& booted, const std::string& next,
               RunningSystem& running) {
  const auto* named = std::get_if<Value::Object>(&slot.is);
  if (named == nullptr || named->size() != 1) return;
  codec::Reading reading;
  const Field field(named->front().second, reading);
  const Field name = field.member("bootname");
  if (name.is_absent() || !name.is<std::string>()) return;  // a part of another slot
  if (name.text() == booted) return;
  const Field good = field.member("boot_status");  // absent if the boot loader's environment is invalid
  running.other = name.text();
  running.other_good = good.is<std::string>() && good.text() == "good";
  running.other_next = named->front().first == next;
}

/// RAUC's words, after their meaning if that is known.
std::string explain_fault(std::string_view fault) {
  const std::string said(fault.substr(0, kLongestFault));
  const auto* const meaning = std::ranges::find_if(
      kMeanings, [fault](std::string_view words) { return fault.contains(words); },
      &std::pair<std::string_view, std::string_view>::first);
  return meaning == std::end(kMeanings) ? said : icd::sentence(meaning->second, " (RAUC: ", said, ")");
}

}  // namespace

bool is_bundle_name(std::string_view name) {
  return name.size() >= kBegin.size() + kEnd.size() && name.starts_with(kBegin) && name.ends_with(kEnd);
}

bool is_plain(std::string_view name) {
  return std::ranges::all_of(name, [](char each) { return each >= ' ' && each <= '~'; });
}

Promise promise_of(std::string_view name, std::string_view compatible) {
  if (!name.starts_with(compatible) || !name.ends_with(kEnd)) return {};
  name.remove_prefix(compatible.size());
  if (!name.starts_with('-')) return {};
  name.remove_prefix(1);
  name.remove_suffix(std::min(kEnd.size(), name.size()));
  return {.for_this_board = true, .version = Version::parse(name)};
}

std::expected<Bundle, std::string> read_info(std::string_view json) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("RAUC's description of the bundle is not JSON: " + root.error());
  codec::Reading reading;
  const Field field(*root, reading);
  const Field compatible = field.member("compatible"), version = field.member("version");
  Bundle bundle{std::string(compatible.text()), std::string(version.text())};
  if (reading.has_refusal()) return std::unexpected("the bundle: " + reading.outcome(0).error().sentence);
  return bundle;
}

std::expected<RunningSystem, std::string> read_status(std::string_view json) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("RAUC's status is not JSON: " + root.error());
  codec::Reading reading;
  const Field field(*root, reading);
  const Field compatible = field.member("compatible"), booted = field.member("booted"),
              slots = field.member("slots");
  RunningSystem running{.compatible = std::string(compatible.text()), .slot = std::string(booted.text())};
  slots.size();
  const Field primary = field.member("boot_primary");  // absent if the boot loader's environment is invalid
  const std::string next(primary.is_absent() ? "" : primary.text());
  if (reading.has_refusal()) return std::unexpected("RAUC: " + reading.outcome(0).error().sentence);
  for (const Value& slot : std::get<Value::Array>(slots.value()->is))
    take_slot(slot, running.slot, next, running);
  if (running.other.empty())
    return std::unexpected("RAUC knows no other slot than " + icd::quote_text(running.slot));
  return running;
}

std::string bundle_error(std::span<const std::uint8_t> head, std::uint64_t size) {
  constexpr std::string_view kMagic = "hsqs";
  constexpr std::size_t kBytesUsed = 40;  // offset of the size in a squashfs, little-endian
  const bool squashfs = head.size() >= kBundleHead && std::equal(kMagic.begin(), kMagic.end(), head.begin());
  if (!squashfs) return "the file is not an update: expected a file adit-BOARD-VERSION.raucb";
  std::uint64_t used = 0;
  for (std::size_t at = kBytesUsed + 8; at-- > kBytesUsed;) used = used << 8 | head[at];
  if (used < size) return "";
  return icd::sentence("the update is incomplete: expected more than ", used, " bytes, got ", size);
}

std::optional<int> percent_in(std::string_view line) {
  const std::size_t digit = line.find_first_not_of(' ');
  if (digit == std::string_view::npos) return std::nullopt;
  int percent = 0;
  const auto [end, error] = std::from_chars(line.data() + digit, line.data() + line.size(), percent);
  if (error != std::errc{} || end == line.data() + line.size() || *end != '%') return std::nullopt;
  return percent >= 0 && percent <= 100 ? std::optional(percent) : std::nullopt;
}

Fault fault_in(std::string_view out, std::string_view err) {
  std::string_view fault;
  while (!err.empty()) {
    const std::string_view line = icd::cut(err, '\n');
    if (!line.empty() && !line.starts_with("rauc-Message")) fault = line;
  }
  while (!out.empty()) {
    const std::string_view line = icd::cut(out, '\n');
    if (line.starts_with(kLastError)) fault = line.substr(kLastError.size());
  }
  const bool busy = fault.find(kBusy) != std::string_view::npos;
  return {busy ? Fault::Kind::Busy : Fault::Kind::Other, explain_fault(fault)};
}

std::string refusal_reason(const Bundle& bundle, const RunningSystem& running, bool again) {
  if (bundle.compatible != running.compatible) {
    return icd::sentence("the update is for another board: ", icd::quote_text(bundle.compatible),
                         ", but this board is ", icd::quote_text(running.compatible));
  }
  const auto offered = Version::parse(bundle.version), present = Version::parse(running.version);
  if (!offered) return "cannot read the update's version: " + icd::quote_text(bundle.version);
  if (!present) return "cannot read the running version: " + icd::quote_text(running.version);
  if (*offered < *present) {
    return icd::sentence("the update is older (", bundle.version, ") than the running version (",
                         running.version, ")");
  }
  if (*offered == *present && !again)
    return bundle.version + " is already running: confirm to install it again";
  return "";
}

}  // namespace adit::update
