#pragma once

#include <string>

#include "journal/folder.hpp"

namespace adit::journal {

/// What a journal's folder tells, read beside a journal that goes on: a snapshot may replace a file that is
/// about to be read.
inline Carried left_in(const std::string& folder) {
  while (true) {
    if (auto carried = Folder(folder).read()) return *std::move(carried);
  }
}

}  // namespace adit::journal
