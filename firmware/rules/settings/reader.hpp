#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"
#include "settings/keys.hpp"
#include "settings/settings.hpp"

namespace adit::settings {

/// Reads objects of the settings file by the table of keys. Reports invalid values and leaves their settings
/// unchanged.
class Reader {
 public:
  /// `pattern`: the path in the table, "team.listen[]". `path`: the path in the file, "team.listen[0]".
  void read_object(const codec::Value& value, const std::string& pattern, const std::string& path);
  /// Reports a member that is not in `children`.
  void tell_unknown(const std::string& name, const std::vector<Child>& children, const std::string& path);

  Settings settings;
  std::vector<Error> errors;
  bool passes_unknown = false;           // unknown keys are not errors
  std::vector<std::string> passed_over;  // their paths

 private:
  void read_child(const Child& child, const codec::Value& value, const std::string& pattern,
                  const std::string& path);
  void read_list(const codec::Value& value, const std::string& pattern, const std::string& path);
  void tell_missing(const Child& child, const std::string& pattern, const std::string& path);
};

/// The value of a JSON text. An error has no path.
std::expected<codec::Value, std::vector<Error>> read_json(std::string_view json);

/// Contradictions between settings that are valid on their own.
std::vector<Error> contradictions(const Settings& settings);

/// The same for the panel alone.
void check_panel(const Panel& panel, std::vector<Error>& errors);

}  // namespace adit::settings
