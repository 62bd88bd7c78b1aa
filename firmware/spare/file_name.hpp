#pragma once

#include <optional>
#include <string>
#include <string_view>

/// What an export's file is called on a stick. Nothing hangs on a name: whose the export is, its sealed
/// content says.
namespace adit::spare {

/// "adit-10.0.0.1-20261123T231600Z.adit-spare", of the box at `box`, which came to rest `at` (seconds since
/// 1970, by its clock).
std::string file_name(std::string_view box, double at);

/// Whether a file of that name on a stick is taken for an export: *.adit-spare, of at most 96 visible
/// characters of ASCII and blanks; not what a Mac leaves beside one ("._*").
bool is_file_name(std::string_view name);

/// What a name says, as far as it does.
struct NamedFor {
  std::string box = "";
  std::optional<double> at = std::nullopt;
  friend bool operator==(const NamedFor&, const NamedFor&) = default;
};
NamedFor named_for(std::string_view name);

/// Whether of two names the first is to be shown before: that of the later export, and those that say when.
bool is_before(std::string_view left, std::string_view right);

}  // namespace adit::spare
