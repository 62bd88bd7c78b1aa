#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "store/contents.hpp"

namespace adit::store {

/// One file of a log, as it is.
struct Scan {
  struct Found {
    Frame frame;
    std::size_t offset;  // of its first copy
    std::size_t good;    // copies
  };
  FileName name;
  std::size_t size = 0;
  std::optional<Found> begin = std::nullopt;  // its header
  std::optional<FileHeader> header = std::nullopt;
  std::vector<Found> frames = {};  // all others, in their order
  std::uint64_t process = 0;       // the highest of any frame
};

/// Finds each frame with a good copy. A frame of an older process behind one of a newer process is left out:
/// the newer process did not know it.
Scan scan(const FileName& name, std::string_view bytes, const Layout& layout);

/// Whether this is a snapshot with all its records and its end.
bool is_whole_snapshot(const Scan& scan);

}  // namespace adit::store
