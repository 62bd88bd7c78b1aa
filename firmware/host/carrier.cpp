#include "host/carrier.hpp"

#include <cerrno>

#include "host/files.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

/// As the kernel's dev_valid_name(): a name that is no path.
bool is_interface_name(const std::string& name) {
  return !name.empty() && name.size() <= 15 && name != "." && name != ".." &&
         name.find_first_of("/: \t\n\v\f\r") == std::string::npos && name.find('\0') == std::string::npos;
}

}  // namespace

std::optional<bool> carrier_in(const std::string& sys_class_net, const std::string& interface) {
  if (!is_interface_name(interface)) return std::nullopt;
  const auto file = slurp(sys_class_net + "/" + interface + "/carrier");
  if (file) return file->text.starts_with('1');
  if (file.error() == EINVAL) return false;  // an interface that is not up has no carrier to tell of
  return std::nullopt;
}

std::optional<bool> carrier(const std::string& interface) {
  return interface.empty() ? true : carrier_in("/sys/class/net", interface);
}

}  // namespace adit::host
