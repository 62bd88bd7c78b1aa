#pragma once

#include <cstdint>
#include <expected>
#include <span>
#include <string>

namespace adit::spare {

/// A file system on a USB stick, or what the box cannot read as one.
struct Medium {
  std::string name = "";  // the kernel's: "sda1"
  std::string disk = "";  // on which it is: "sda"
  bool is_mounted = false;
  bool is_write_protected = false;
  std::uint64_t room = 0;  // bytes
};

/// Where an export of so many bytes is to be written. An error is a sentence for whoever stands at the box:
/// there is no stick or more than one, and nobody must have to look for the export on each; none that can be
/// read; no room. Of the partitions of one stick, that with the most room.
std::expected<Medium, std::string> medium_for(std::span<const Medium> media, std::uint64_t size);

}  // namespace adit::spare
