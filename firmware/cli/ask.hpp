#pragma once

#include <chrono>
#include <expected>
#include <string>

#include "cli/options.hpp"
#include "cli/outcome.hpp"
#include "settings/settings.hpp"

namespace adit::cli {

/// Where the Adit is that the options mean.
std::expected<settings::Address, std::string> address_of(const Options& options);

/// The body of a 200, or a sentence.
std::expected<std::string, std::string> get(const settings::Address& address, const std::string& target);

/// The sentence that an error's body is (a JSON string); "" where it is none.
std::string sentence_in(const std::string& body);

/// `why` on standard error.
Outcome unable(const std::string& why);

/// `adit status`: asks the running Adit and shows its answer.
Outcome status(const Options& options, bool colour);

}  // namespace adit::cli
