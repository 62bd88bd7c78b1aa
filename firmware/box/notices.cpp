#include "box/notices.hpp"

#include <algorithm>
#include <filesystem>

#include "host/service.hpp"

namespace adit::box {
namespace {

constexpr std::size_t kMostNotices = 8, kLongestNotice = 500;

}  // namespace

std::vector<std::string> read_notices(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code unknown;
    if (entry->is_regular_file(unknown)) paths.push_back(entry->path());
  }
  std::ranges::sort(paths);

  std::vector<std::string> notices;
  for (const std::string& path : paths) {
    const auto text = host::read_file(path);
    if (!text) continue;
    const std::string line = text->substr(0, std::min(text->find('\n'), kLongestNotice));
    if (!line.empty() && notices.size() < kMostNotices) notices.push_back(line);
  }
  return notices;
}

}  // namespace adit::box
