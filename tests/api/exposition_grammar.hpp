#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace adit::api {

/// Violations of the exposition format 0.0.4 (and of Prometheus' rules for names), one sentence each. Each
/// metric must have one HELP and one TYPE before its samples, which stand together. No sample may occur
/// twice. A counter must end in _total and must not be negative.
std::vector<std::string> faults_of(std::string_view text);

}  // namespace adit::api
