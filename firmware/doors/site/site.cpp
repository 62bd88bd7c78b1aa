#include "site/site.hpp"

#include <algorithm>
#include <utility>

namespace adit::site {
namespace {

constexpr std::pair<std::string_view, std::string_view> kContentTypes[] = {
    {".html", "text/html; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".json", "application/json"},
    {".svg", "image/svg+xml"},
};

}  // namespace

const File* file_at(std::string_view path) {
  const auto files = embedded_files();
  if (path == "/") path = "/index.html";
  if (path == "/display") path = "/display.html";
  if (path == "/help") path = "/help.html";
  if (path == "/runs") path = "/runs.html";
  if (path == "/system") path = "/system.html";
  if (path == "/setup") path = "/setup.html";
  const auto found = std::ranges::find(files, path, &File::path);
  return found == files.end() ? nullptr : &*found;
}

std::string_view content_type_of(const File& file) {
  for (const auto& [ending, type] : kContentTypes) {
    if (file.path.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

}  // namespace adit::site
