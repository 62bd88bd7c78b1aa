#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row.hpp"
#include "codec/value.hpp"
#include "settings/settings.hpp"

namespace adit::settings {

/// Reads objects of the settings file by their rows. Reports invalid values.
class Reader {
 public:
  /// Reads a struct of `row`. `path`: of the object in the file, "team.listen[0]".
  void read_object(const codec::Value& value, const codec::Row& row, void* into, const std::string& path);

  std::vector<Error> errors;
  bool passes_unknown = false;              // unknown keys are not errors
  std::vector<std::string> passed_over;     // their paths
  std::vector<std::string> without_effect;  // paths of an earlier version's keys

 private:
  void read_member(const codec::Value& value, const codec::Member& member, void* into,
                   const std::string& path);
  void read_list(const codec::Value& value, const codec::Member& member, void* list, const std::string& path);
  void report_unknown(const std::string& name, const codec::Row& row, const std::string& path);
  void report_missing(const codec::Member& member, void* into, const std::string& path);
};

/// The valid values in words: "1 to 65535", "a list of 1 to 16 items".
std::string range_of(const codec::Member& member);

/// The value of a JSON text. An error has no path.
std::expected<codec::Value, std::vector<Error>> read_json(std::string_view json);

/// Contradictions between settings that are valid on their own.
std::vector<Error> contradictions(const Settings& settings);

/// The same for the panel alone.
void check_panel(const Panel& panel, std::vector<Error>& errors);

}  // namespace adit::settings
