#include "box/notices.hpp"

#include <algorithm>

#include "host/root_program.hpp"
#include "host/service.hpp"

namespace adit::box {
namespace {

constexpr std::size_t kMostNotices = 8, kLongestNotice = 500;

}  // namespace

std::map<std::string, std::string> read_notices(const std::string& folder) {
  std::map<std::string, std::string> notices;
  const auto names = host::names_in(folder);
  if (!names) notices.emplace("notices", "cannot list " + folder + ": " + names.error());
  for (const std::string& name : names.value_or(std::vector<std::string>())) {
    const auto text = host::read_if_there(folder + '/' + name);
    const std::string said = text ? text->value_or("") : "cannot read " + text.error();
    const std::string line = said.substr(0, std::min(said.find('\n'), kLongestNotice));
    if (!line.empty() && notices.size() < kMostNotices) notices.emplace(name, line);
  }
  return notices;
}

}  // namespace adit::box
