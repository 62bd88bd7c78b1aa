#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "host/service.hpp"

namespace adit::admin {

/// What `read` makes of a file's text; a new one where there is no file. An error names the file.
template <class Read>
auto read_kept_file(const std::string& file, Read read) -> decltype(read(std::string_view())) {
  if (!host::may_exist(file)) return {};
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(text.error());
  auto kept = read(*text);
  if (!kept) return std::unexpected(file + ": " + kept.error());
  return kept;
}

}  // namespace adit::admin
