#include "host/carrier.hpp"

#include <cerrno>

#include "host/files.hpp"
#include "host/interface_name.hpp"
#include "host/service.hpp"

namespace adit::host {

std::optional<bool> carrier_in(const std::string& sys_class_net, const std::string& interface) {
  if (!is_interface_name(interface)) return std::nullopt;
  const auto file = slurp(sys_class_net + "/" + interface + "/carrier");
  if (file) return file->text.starts_with('1');
  if (file.error() == EINVAL) return false;  // an interface that is down has no carrier
  return std::nullopt;
}

std::optional<bool> carrier(const std::string& interface) {
  return interface.empty() ? true : carrier_in("/sys/class/net", interface);
}

}  // namespace adit::host
