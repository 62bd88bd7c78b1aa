#include "applier/os_release.hpp"

#include "host/service.hpp"
#include "update/health.hpp"

namespace adit::applier {

std::string version_in(const std::string& path) {
  const auto text = host::read_file(path);
  std::string value(text ? update::value_of("VERSION_ID", *text) : "");
  std::erase(value, '"');
  return value;
}

}  // namespace adit::applier
