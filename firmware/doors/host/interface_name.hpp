#pragma once

#include <string_view>

namespace adit::host {

/// The kernel's dev_valid_name(). Such a name cannot be a path.
inline bool is_interface_name(std::string_view name) {
  return !name.empty() && name.size() <= 15 && name != "." && name != ".." &&
         name.find_first_of("/: \t\n\v\f\r") == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

}  // namespace adit::host
