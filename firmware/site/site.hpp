#pragma once

#include <span>
#include <string_view>

namespace adit::site {

/// A file of the page, embedded in the program.
struct File {
  std::string_view path;    // "/page.css"
  std::string_view etag;    // with its quotation marks (RFC 9110 8.8.3)
  std::string_view packed;  // its bytes, under gzip
};

std::span<const File> embedded_files();

/// The file that a request's path names ("/" is index.html, "/system" system.html and so on), or null.
const File* file_at(std::string_view path);

/// By the file's ending.
std::string_view content_type_of(const File& file);

}  // namespace adit::site
