#pragma once

#include <span>
#include <string_view>

namespace adit::site {

/// A file that is served, embedded in the program: `bundle` makes them of what is in files/.
struct File {
  std::string_view path;    // "/index.5c3a1f2e9b70.css"
  std::string_view etag;    // without quotation marks (RFC 9110 8.8.3)
  std::string_view packed;  // its bytes, under gzip
  bool is_hashed;           // its name holds a hash of its bytes: under this name they never change
};

std::span<const File> embedded_files();

/// The file that a request's path names ("/" is index.html, "/system" system.html and so on), or null.
const File* file_at(std::string_view path);

/// By the file's ending.
std::string_view content_type_of(const File& file);

}  // namespace adit::site
