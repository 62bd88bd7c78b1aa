#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"

namespace adit::cli {

/// One key of the settings, as GET /adit/settings describes it, with its value for each place that it has: of
/// an item of a list "robots[0].alias".
struct ShownKey {
  codec::Value described;
  codec::Value::Object values;  // by path
};

/// The keys that `name` is, or that begin with it ("reports" of "reports.review"), of Adit's answer; or that
/// there is none, and which was likely meant.
std::expected<std::vector<ShownKey>, std::string> keys_named(const codec::Value& answer,
                                                             const std::string& name);

/// The value at "reports.review", "team.listen[0].port" or "robots[ugv1].alias"; null if there is none.
codec::Value* value_at(codec::Value& settings, std::string_view path);

/// A value as people read it: a text without quotes.
std::string plain(const codec::Value& value);

std::string text_of(const std::vector<ShownKey>& keys, bool colour);
codec::Value json_of(const std::vector<ShownKey>& keys);

}  // namespace adit::cli
