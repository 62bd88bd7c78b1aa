#pragma once

#include <string>

#include "journal/journal.hpp"

namespace adit::journal {

/// Reads a journal's directory while the journal is in use: a snapshot may replace a file that is about to
/// be read.
inline HandoverState left_in(const std::string& path) {
  while (true) {
    const auto directory = store::Directory::open(path);
    if (!directory) continue;
    if (const auto contents = store::Contents::read(*directory, Journal::kKeeping))
      return read_records(*contents).first;
  }
}

}  // namespace adit::journal
