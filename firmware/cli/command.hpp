#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "cli/outcome.hpp"

namespace adit::cli {

/// The whole of `adit`, but for printing: `words` are its arguments. What takes a while gives its lines to
/// `print` as they come, and the rest in the Outcome.
Outcome run(
    std::span<const std::string_view> words, bool colour,
    const std::function<void(const std::string&)>& print = [](const std::string&) {});

}  // namespace adit::cli
