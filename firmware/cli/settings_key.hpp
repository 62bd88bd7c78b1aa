#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/settings_rows.hpp"
#include "cli/ask.hpp"

namespace adit::cli {

/// Why Adit's settings cannot be read is a failure.
Result<settings::Settings> settings_in(const api::SetupView& setup);

/// One key of the settings, with its value for each place that it has: of an item of a list
/// "robots[0].alias".
struct ShownKey {
  api::KeyRow described;
  codec::Value::Object values;  // by path
};

/// The keys that `name` is, or that begin with it ("reports" of "reports.review"). If there is none, the
/// failure names the key that was likely meant.
Result<std::vector<ShownKey>> keys_named(const api::SetupView& setup, const std::string& name);

/// The value at "reports.review", "team.listen[0].port" or "robots[ugv1].alias"; null if there is none.
codec::Value* value_at(codec::Value& settings, std::string_view path);

/// A value as people read it: a text without quotes.
std::string plain(const codec::Value& value);

std::string text_of(const std::vector<ShownKey>& keys, bool colour);
codec::Value json_of(const std::vector<ShownKey>& keys);

}  // namespace adit::cli
