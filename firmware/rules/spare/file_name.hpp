#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Names of export files on a stick. Names only inform; the sealed content says whose export it is.
namespace adit::spare {

/// "adit-10.0.0.1-20261123T231600Z.adit-spare". `box`: its address. `at`: start of its standby, in seconds
/// since 1970 by its clock.
std::string file_name(std::string_view box, double at);

/// Whether a file on a stick may be an export: *.adit-spare, at most 96 characters of visible ASCII and
/// blanks. The companion files of a Mac ("._*") are not.
bool is_file_name(std::string_view name);

/// The parts of a name, as far as present.
struct NamedFor {
  std::string box = "";
  std::optional<double> at = std::nullopt;
  friend bool operator==(const NamedFor&, const NamedFor&) = default;
};
NamedFor named_for(std::string_view name);

/// Order of display: names with a time first, then the latest first.
bool is_before(std::string_view left, std::string_view right);

}  // namespace adit::spare
