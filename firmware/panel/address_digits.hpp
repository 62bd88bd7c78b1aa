#pragma once

#include <string_view>
#include <vector>

#include "panel/panel.hpp"

namespace adit::panel {

/// An IPv4 address as flashes that can be counted: for each digit as many as it says (ten for 0), for each
/// dot a long one; after each a pause. Twice, with a longer pause between. `address` is in its text form;
/// what is neither digit nor dot is left out.
std::vector<Step> address_digits(std::string_view address);

}  // namespace adit::panel
