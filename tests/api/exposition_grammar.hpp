#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace adit::api {

/// What is wrong with a text by the exposition format 0.0.4 (and by Prometheus' rules for names): a sentence
/// for each fault. Strict: each metric has one HELP and one TYPE before its samples, which stand together; no
/// sample is there twice; a counter ends in _total and is no less than 0.
std::vector<std::string> faults_of(std::string_view text);

}  // namespace adit::api
