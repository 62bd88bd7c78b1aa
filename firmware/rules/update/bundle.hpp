#pragma once

#include <compare>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row.hpp"

namespace adit::update {

/// A version of Semantic Versioning 2.0: "0.2.0", "1.0.0-rc.1", "1.0.0+a1b2c3". Ordered by clause 11: numbers
/// by value, a pre-release before its release, build metadata ignored.
class Version {
 public:
  static constexpr std::size_t kLongest = 64;

  /// std::nullopt if the text is not a version.
  static std::optional<Version> parse(std::string_view text);

  friend std::strong_ordering operator<=>(const Version& left, const Version& right);
  friend bool operator==(const Version& left, const Version& right) { return (left <=> right) == 0; }

 private:
  std::vector<std::uint64_t> release_;    // major, minor, patch
  std::vector<std::string> pre_release_;  // empty for a release
};

/// Whether a file on a stick may be a bundle: "adit-*.raucb".
bool is_bundle_name(std::string_view name);

/// Whether the name has only visible ASCII and spaces.
bool is_plain(std::string_view name);

/// A file name's promise; the best compares greatest. toolchain/image names files COMPATIBLE-VERSION.raucb.
struct Promise {
  bool for_this_board = false;
  std::optional<Version> version = {};
  friend auto operator<=>(const Promise&, const Promise&) = default;
};
Promise promise_of(std::string_view name, std::string_view compatible);

/// A bundle's own description, after its signature was verified.
struct Bundle {
  std::string compatible = "";  // the board: "adit-qemu-virt"
  std::string version = "";
};

/// The running system.
struct RunningSystem {
  std::string compatible = "";
  std::string version = "";
  std::string slot = "";    // boot loader's name: "A"
  std::string other = "";   // the slot for an update: "B"
  bool other_next = false;  // the boot loader starts `other` next; not stored
  bool other_good = false;  // `other` has tries left; not stored
  static const codec::Row kRow;
  friend bool operator==(const RunningSystem&, const RunningSystem&) = default;
};

/// Read `rauc info --output-format=json` and `rauc status ...`, which does not know RunningSystem::version.
std::expected<Bundle, std::string> read_info(std::string_view json);
std::expected<RunningSystem, std::string> read_status(std::string_view json);

/// Bytes that bundle_error() reads.
inline constexpr std::size_t kBundleHead = 48;
/// Why a file of `size` bytes with these first kBundleHead bytes (or all, if shorter) cannot be a bundle, or
/// "". A bundle is a squashfs (Documentation/filesystems/squashfs.rst) followed by its signature.
std::string bundle_error(std::span<const std::uint8_t> head, std::uint64_t size);

/// The percentage in a line of `rauc install --progress`: " 40% Verifying signature done."
std::optional<int> percent_in(std::string_view line);

/// An error of RAUC. RAUC reports only sentences; the one that decides control flow is known only here.
struct Fault {
  enum class Kind {
    Busy,  // it installs or marks and gives no answers: ask again
    Other,
  };
  Kind kind = Kind::Other;
  std::string sentence = "";  // "": no message
  friend bool operator==(const Fault&, const Fault&) = default;
};
Fault fault_in(std::string_view out, std::string_view err);

/// Why the bundle must not be installed, or "". `again`: allows the running version.
std::string refusal_reason(const Bundle& bundle, const RunningSystem& running, bool again);

}  // namespace adit::update
