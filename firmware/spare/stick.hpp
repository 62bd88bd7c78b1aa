#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row_file.hpp"

/// The files by which aditd, which has no privilege, and adit-spare, which runs as root, speak with each
/// other about the stick in the box: README.md.
namespace adit::spare {

/// What aditd asks for, and the export that is to be written, in its own state folder; adit-spare takes both
/// away.
inline constexpr const char* kStickRequestFile = "stick.json";
inline constexpr const char* kForStickFile = "stick.adit-spare";
/// The export that adit-spare read from a stick, in its runtime directory.
inline constexpr const char* kFromStickFile = "export.adit-spare";

struct StickRequest {
  enum class What : std::uint8_t { Write, Take };
  std::string nonce = "";  // codec::is_nonce()
  What what = What::Take;
  std::string name = "";  // is_file_name(): of the file on the stick
  static const codec::Row kRow;
};

struct StickStatus {
  std::string nonce = "";      // of the last request that was taken up
  std::string refusal = "";    // why it was not done; "" where it was, or is being done
  std::string doing = "";      // "", "writing", "checking", "reading"
  std::string written = "";    // of the last request: the file that is on the stick, read back and the same
  std::string hindrance = "";  // why no export can be written; "": it can
  std::vector<std::string> exports = {};  // names of those on the sticks, the latest first
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const StickStatus&, const StickStatus&) = default;
};

}  // namespace adit::spare
