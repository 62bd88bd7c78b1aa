#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/row.hpp"

namespace adit::update {

/// What an update says of itself, once its signature was found good.
struct Bundle {
  std::string compatible = "";  // the board that it is for: "adit-qemu-virt"
  std::string version = "";
};

/// What the box is.
struct Running {
  std::string compatible = "";
  std::string version = "";
  std::string slot = "";    // the boot loader's name: "A"
  std::string other = "";   // the slot that an update goes into: "B"
  bool other_next = false;  // the boot loader starts that one next; known here alone, no file says it
  bool other_good = false;  // the boot loader has tries left for it; known here alone too
  static const codec::Row kRow;
  friend bool operator==(const Running&, const Running&) = default;
};

/// Reads what `rauc info --output-format=json` and `rauc status --output-format=json` print; an error says
/// what is not as it must be. Running::version is not RAUC's to know.
std::expected<Bundle, std::string> read_info(std::string_view json);
std::expected<Running, std::string> read_status(std::string_view json);

/// How many bytes not_a_bundle() looks at.
inline constexpr std::size_t kBundleHead = 48;
/// Why what begins with these `kBundleHead` bytes (or with all there are) and has `size` bytes cannot be a
/// bundle, or
/// "". A bundle is a squashfs (Documentation/filesystems/squashfs.rst) with its signature behind it.
std::string not_a_bundle(std::span<const std::uint8_t> head, std::uint64_t size);

/// The per cent in a line of `rauc install --progress`, " 40% Verifying signature done."
std::optional<int> percent_in(std::string_view line);

/// What RAUC says went wrong. It tells its callers by sentences alone: the one that control hangs on is known
/// here, and nowhere else.
struct Fault {
  enum class Kind {
    Busy,  // it installs or marks, and answers nothing else meanwhile: ask again
    Other,
  };
  Kind kind = Kind::Other;
  std::string sentence = "";  // "": it says nothing
  friend bool operator==(const Fault&, const Fault&) = default;
};
/// Out of its standard output and its standard error.
Fault fault_in(std::string_view out, std::string_view err);

/// Why the bundle must not be installed, or "". `again`: the version that runs already may be.
std::string hindrance(const Bundle& bundle, const Running& running, bool again);

}  // namespace adit::update
