#include "intake/head.hpp"

#include <microhttpd.h>

namespace adit::intake {
std::string_view Head::query(std::string_view name) const {
  for (const auto& [key, value] : target_.query) {
    if (key == name) return value;
  }
  return {};
}

std::string_view Head::header(std::string_view name) const {
  const char* value = nullptr;
  std::size_t size = 0;
  if (MHD_lookup_connection_value_n(connection_, MHD_HEADER_KIND, name.data(), name.size(), &value, &size) !=
          MHD_YES ||
      value == nullptr) {
    return {};
  }
  return {value, size};
}

}  // namespace adit::intake
