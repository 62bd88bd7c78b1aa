#pragma once

#include <fstream>
#include <iterator>
#include <string>

namespace adit::panel {

/// The text of a file of the project.
inline std::string text_of(const std::string& path) {
  std::ifstream stream(ADIT_SOURCE_DIR "/" + path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace adit::panel
