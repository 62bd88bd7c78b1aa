#include "uplink/http_date.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

namespace adit::uplink {
namespace {

constexpr std::string_view kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                        "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
constexpr std::string_view kForm = "Sun, 06 Nov 1994 08:49:37 GMT";

/// The decimal digits of `text`, all of them; -1 where they are none.
int digits(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size() && text.front() != '-';
  return whole ? number : -1;
}

}  // namespace

std::optional<std::chrono::sys_seconds> http_date(std::string_view text) {
  using namespace std::chrono;
  if (text.size() != kForm.size() || !text.ends_with(" GMT") || text.substr(3, 2) != ", " || text[7] != ' ' ||
      text[11] != ' ' || text[16] != ' ' || text[19] != ':' || text[22] != ':') {
    return std::nullopt;
  }
  const auto name = std::ranges::find(kMonths, text.substr(8, 3));
  const int day_of = digits(text.substr(5, 2)), year_of = digits(text.substr(12, 4)),
            hour = digits(text.substr(17, 2)), minute = digits(text.substr(20, 2)),
            second = digits(text.substr(23, 2));
  if (name == std::end(kMonths) || day_of < 0 || year_of < 0) return std::nullopt;
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 || second > 60) return std::nullopt;
  const year_month_day date{year(year_of), month(static_cast<unsigned>(name - std::begin(kMonths) + 1)),
                            day(static_cast<unsigned>(day_of))};
  if (!date.ok()) return std::nullopt;
  return sys_days(date) + hours(hour) + minutes(minute) + seconds(second);
}

}  // namespace adit::uplink
