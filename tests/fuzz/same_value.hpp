#pragma once

#include <nlohmann/json.hpp>

#include "codec/value.hpp"

namespace adit::fuzz {

/// Whether Adit and nlohmann's reader read the same. Adit keeps members that are given twice, to refuse them,
/// where the other keeps the last.
bool is_same(const codec::Value& ours, const nlohmann::json& theirs);

/// Whether it has a number that no double holds, which Adit refuses where a number is asked for.
bool has_infinity(const codec::Value& ours);

}  // namespace adit::fuzz
