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

/// Reads one of RAUC's slots, an object with one member, the slot's name. `next`: name of the slot to start
/// next.
void take_slot(const Value& slot, const std::string& booted, const std::string& next, Running& running) {
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
std::string explained(std::string_view fault) {
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
  if (reading.refused()) return std::unexpected("the bundle: " + reading.outcome(0).error().sentence);
  return bundle;
}

std::expected<Running, std::string> read_status(std::string_view json) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("RAUC's status is not JSON: " + root.error());
  codec::Reading reading;
  const Field field(*root, reading);
  const Field compatible = field.member("compatible"), booted = field.member("booted"),
              slots = field.member("slots");
  Running running{.compatible = std::string(compatible.text()), .slot = std::string(booted.text())};
  slots.size();
  const Field primary = field.member("boot_primary");  // absent if the boot loader's environment is invalid
  const std::string next(primary.is_absent() ? "" : primary.text());
  if (reading.refused()) return std::unexpected("RAUC: " + reading.outcome(0).error().sentence);
  for (const Value& slot : std::get<Value::Array>(slots.value()->is))
    take_slot(slot, running.slot, next, running);
  if (running.other.empty())
    return std::unexpected("RAUC knows no other slot than " + icd::in_quotes(running.slot));
  return running;
}

std::string not_a_bundle(std::span<const std::uint8_t> head, std::uint64_t size) {
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
  return {busy ? Fault::Kind::Busy : Fault::Kind::Other, explained(fault)};
}

std::string hindrance(const Bundle& bundle, const Running& running, bool again) {
  if (bundle.compatible != running.compatible) {
    return icd::sentence("the update is for another board: ", icd::in_quotes(bundle.compatible),
                         ", but this board is ", icd::in_quotes(running.compatible));
  }
  const auto offered = Version::parse(bundle.version), present = Version::parse(running.version);
  if (!offered) return "cannot read the update's version: " + icd::in_quotes(bundle.version);
  if (!present) return "cannot read the running version: " + icd::in_quotes(running.version);
  if (*offered < *present) {
    return icd::sentence("the update is older (", bundle.version, ") than the running version (",
                         running.version, ")");
  }
  if (*offered == *present && !again)
    return bundle.version + " is already running: confirm to install it again";
  return "";
}

}  // namespace adit::update
