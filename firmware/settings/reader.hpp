#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"
#include "settings/keys.hpp"
#include "settings/settings.hpp"

namespace adit::settings {

/// Reads objects of the settings file by the table of keys. Whatever is wrong is told, and left as it was.
class Reader {
 public:
  /// `pattern` is the path as the table writes it, "team.listen[]"; `path` as it is in the file,
  /// "team.listen[0]".
  void read_object(const codec::Value& value, const std::string& pattern, const std::string& path);
  /// Tells that the object at `path` has a member that is none of `children`.
  void tell_unknown(const std::string& name, const std::vector<Child>& children, const std::string& path);

  Settings settings;
  std::vector<Error> errors;
  bool passes_unknown = false;           // unknown keys are no errors
  std::vector<std::string> passed_over;  // their paths

 private:
  void read_child(const Child& child, const codec::Value& value, const std::string& pattern,
                  const std::string& path);
  void read_list(const codec::Value& value, const std::string& pattern, const std::string& path);
  void tell_missing(const Child& child, const std::string& pattern, const std::string& path);
};

/// "team.listen"
std::string joined(const std::string& path, std::string_view name);

}  // namespace adit::settings
