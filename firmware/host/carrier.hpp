#pragma once

#include <optional>
#include <string>

namespace adit::host {

/// carrier() by the kernel's list of interfaces in `sys_class_net`.
std::optional<bool> carrier_in(const std::string& sys_class_net, const std::string& interface);

}  // namespace adit::host
