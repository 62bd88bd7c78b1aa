#pragma once

#include <string_view>
#include <vector>

#include "panel/panel.hpp"

namespace adit::panel {

/// An IPv4 address as flashes to count. A digit is that many flashes (ten for 0), a dot one long flash. A
/// pause follows each. The address is shown twice, with a longer pause between. `address` is in text form;
/// characters other than digits and dots are skipped.
std::vector<Step> address_digits(std::string_view address);

}  // namespace adit::panel
