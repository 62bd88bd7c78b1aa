#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "store/contents.hpp"

namespace adit::store {

/// A log file as found.
struct Scan {
  struct Found {
    Frame frame;
    std::size_t offset;  // of its first copy
    std::size_t good;    // good copies
  };
  FileName name;
  std::size_t size = 0;
  std::optional<Found> begin = std::nullopt;  // the file's header
  std::optional<FileHeader> header = std::nullopt;
  std::vector<Found> frames = {};  // all other frames, in order
  std::uint64_t process = 0;       // highest process number in a frame
};

/// Finds all frames with a good copy. Skips frames of an older process after those of a newer one, because
/// the newer process did not know them.
Scan scan(const FileName& name, std::string_view bytes, const Layout& layout);

/// Whether a snapshot has all records and its end.
bool is_whole_snapshot(const Scan& scan);

}  // namespace adit::store
