#pragma once

#include <cstdint>
#include <expected>
#include <span>
#include <string>

namespace adit::spare {

/// A file system on a USB stick, mounted if the box can read it.
struct Medium {
  std::string name = "";  // kernel's name: "sda1"
  std::string disk = "";  // its disk: "sda"
  bool is_mounted = false;
  bool is_write_protected = false;
  std::uint64_t room = 0;  // free bytes
};

/// Where to write an export of `size` bytes: the partition with the most room of the only stick. An error is
/// a sentence for the user at the box: no stick, several sticks (the export must not have to be searched
/// for), a stick that cannot be read or written, or no room.
std::expected<Medium, std::string> medium_for(std::span<const Medium> media, std::uint64_t size);

}  // namespace adit::spare
