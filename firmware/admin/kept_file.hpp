#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "host/service.hpp"

namespace adit::admin {

/// What `read` makes of a file's text; a new one if there is no file. An error names the file. `unread`: the
/// error if the file cannot be read; otherwise as it was. The caller must not replace such a file.
template <class Read>
auto read_kept_file(const std::string& file, Read read, std::string& unread)
    -> decltype(read(std::string_view())) {
  if (!host::may_exist(file)) return {};
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(unread = text.error());
  auto kept = read(*text);
  if (!kept) return std::unexpected(file + ": " + kept.error());
  return kept;
}

}  // namespace adit::admin
