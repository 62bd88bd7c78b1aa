#include "api/log_filter.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "api/number_in.hpp"
#include "icd/letter_case.hpp"
#include "icd/refuse.hpp"

namespace adit::api {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 5> kPriorities = {
    {{"error", 3}, {"warning", 4}, {"notice", 5}, {"info", 6}, {"debug", 7}}};

}  // namespace

bool LogFilter::lets(const LogRecord& record) const {
  if (record.severity > severity || record.seq <= after) return false;
  const auto same = [](char a, char b) { return icd::lower(a) == icd::lower(b); };
  return text.empty() || !std::ranges::search(record.line, text, same).empty();
}

icd::Checked<LogFilter> read_log_filter(const intake::RequestHead& head) {
  LogFilter filter{.text = std::string(head.query("text"))};
  if (const auto level = head.query("level"); !level.empty()) {
    const auto known = std::ranges::find(kPriorities, level, [](const auto& each) { return each.first; });
    if (known == kPriorities.end())
      return icd::refuse(icd::Status::BadRequest, "level: expected error, warning, notice, info or debug");
    filter.severity = known->second;
  }
  if (const auto since = head.query("since"); !since.empty()) {
    const auto number = icd::number_in<std::uint64_t>(since);
    if (!number) return icd::refuse(icd::Status::BadRequest, "since: expected the number of a record");
    filter.after = *number;
  }
  return filter;
}

}  // namespace adit::api
