#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row.hpp"

/// Names of export files on a stick. Names only inform; the sealed content says whose export it is.
namespace adit::spare {

/// "adit-10.0.0.1-20261123T231600Z.adit-spare": `box`'s address, and its standby `at`, in seconds since 1970.
std::string file_name(std::string_view box, double at);

/// Whether a file on a stick may be an export: *.adit-spare, at most 96 characters of visible ASCII and
/// blanks. The companion files of a Mac ("._*") are not.
bool is_file_name(std::string_view name);

/// The parts of a name, as far as present.
struct ExportName {
  std::string box = "";
  std::optional<double> at = std::nullopt;
  friend bool operator==(const ExportName&, const ExportName&) = default;
};
ExportName named_for(std::string_view name);

/// Order of display: names with a time first, then the latest first.
bool is_before(std::string_view left, std::string_view right);

}  // namespace adit::spare

/// Messages, as files, about the stick, between aditd (no privileges) and adit-spare (root): README.md.
namespace adit::spare {

/// A file system on a USB stick, mounted if the box can read it.
struct Medium {
  std::string name = "";  // kernel's name: "sda1"
  std::string disk = "";  // its disk: "sda"
  bool is_mounted = false;
  bool is_write_protected = false;
  std::uint64_t room = 0;  // free bytes
};

/// Why a stick is not mounted.
inline constexpr const char* kUnknownFileSystem =
    "the box cannot read the stick's file system: expected FAT32, exFAT or ext4";

/// Where to write an export of `size` bytes: the partition with the most room of the only stick. An error is
/// a sentence for the user at the box: no stick, several sticks (the export must not have to be searched
/// for), a stick that cannot be read or written, or no room.
std::expected<Medium, std::string> medium_for(std::span<const Medium> media, std::uint64_t size);

/// aditd's request and the export to write, in aditd's state directory. adit-spare removes both.
inline constexpr const char* kStickRequestFile = "stick.json";
inline constexpr const char* kForStickFile = "stick.adit-spare";
/// The export that adit-spare read from a stick, in its runtime directory.
inline constexpr const char* kFromStickFile = "export.adit-spare";

struct StickRequest {
  enum class Command : std::uint8_t { Write, Take };
  std::string nonce = "";  // codec::is_nonce()
  Command what = Command::Take;
  std::string name = "";  // is_file_name(): the file on the stick
  static const codec::Row kRow;
};

struct StickStatus {
  std::string nonce = "";                 // of the last request that was read
  std::string refusal = "";               // why that request failed; "": done or in progress
  std::string doing = "";                 // "", "writing", "checking", "reading"
  std::string written = "";               // by the last request: the verified file on the stick
  std::string hindrance = "";             // why no export can be written, or ""
  std::string unreadable = "";            // without exports: why a stick cannot be read, or ""
  std::vector<std::string> exports = {};  // on the sticks, the latest first
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const StickStatus&, const StickStatus&) = default;
};

}  // namespace adit::spare
