#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "host/service.hpp"

namespace adit::admin {

/// Parses a file's text by `read`, or returns a new value if there is no file. An error names the file. If
/// the file cannot be read, sets `unread` to the error; the caller must then not replace the file.
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
