#pragma once

#include <string>
#include <vector>

#include "api/box.hpp"

namespace adit::api {

std::string write_about(const About& about, Time now);
std::string write_network(const NetworkState& network);
/// `last`: the number of the last record there was, whether or not it is among them.
std::string write_log(const std::vector<LogRecord>& records, std::uint64_t last);

}  // namespace adit::api
