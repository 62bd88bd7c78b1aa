#include "box/notices.hpp"

#include <algorithm>

#include "host/service.hpp"

namespace adit::box {
namespace {

constexpr std::size_t kMostNotices = 8, kLongestNotice = 500;

}  // namespace

std::map<std::string, std::string> read_notices(const std::string& folder) {
  std::map<std::string, std::string> notices;
  for (const std::string& name : host::names_in(folder).value_or(std::vector<std::string>())) {
    const auto text = host::read_file(folder + '/' + name);
    if (!text) continue;
    const std::string line = text->substr(0, std::min(text->find('\n'), kLongestNotice));
    if (!line.empty() && notices.size() < kMostNotices) notices.emplace(name, line);
  }
  return notices;
}

}  // namespace adit::box
