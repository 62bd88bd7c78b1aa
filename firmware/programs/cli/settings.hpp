#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/settings_rows.hpp"
#include "cli/ask.hpp"

namespace adit::cli {

/// Error: Adit's settings cannot be read.
Result<settings::Settings> settings_in(const api::SetupView& setup);

/// A settings key with its values; a list's key has one for each item ("robots[0].alias").
struct ShownKey {
  api::KeyRow described;
  codec::Value::Object values;  // by path
};

/// The key `name`, or the keys below it ("reports" of "reports.review"). Else an error, which suggests a key.
Result<std::vector<ShownKey>> keys_named(const api::SetupView& setup, const std::string& name);

/// The value at "reports.review", "team.listen[0].port" or "robots[ugv1].alias", or null.
codec::Value* value_at(codec::Value& settings, std::string_view path);

/// A value for people: a text has no quotes.
std::string plain(const codec::Value& value);

std::string text_of(const std::vector<ShownKey>& keys, bool colour);
codec::Value json_of(const std::vector<ShownKey>& keys);

}  // namespace adit::cli
