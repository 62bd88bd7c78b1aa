#pragma once

#include <string>

namespace adit::alarms {

/// "45 s", "12 min", "2:05 h", as the page's age(). `seconds` may be negative.
std::string age_text(double seconds);
/// Minutes and seconds: "1:34", "61:15".
std::string clock_text(double seconds);
/// "scoring" -> "Scoring"
std::string capital(std::string text);

/// One line: "The scoring token is missing: reports stay queued until a token is set".
template <class Said>
std::string line_of(const Said& said) {
  return said.why.empty() ? said.what : said.what + ": " + said.why;
}

}  // namespace adit::alarms
