#pragma once

#include <optional>
#include <string>

namespace adit::host {

/// As carrier(). `sys_class_net`: the kernel's list of interfaces.
std::optional<bool> carrier_in(const std::string& sys_class_net, const std::string& interface);

}  // namespace adit::host
