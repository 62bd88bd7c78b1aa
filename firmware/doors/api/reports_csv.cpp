#include "api/reports_csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string_view>

#include "codec/utf8.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

/// C0 controls and DEL, or C1 controls (U+0080 to U+009F), which some terminals execute.
bool is_control(std::string_view character) {
  const auto last = static_cast<unsigned char>(character.back());
  if (character.size() == 1) return last < 0x20 || last == 0x7f;
  return character.size() == 2 && character.front() == '\xc2' && last < 0xa0;
}

/// Valid UTF-8 with a space for each control character, because RFC 4180 text has none.
std::string plain(std::string_view text) {
  std::string all;
  while (!text.empty()) {
    const std::size_t size = codec::character_size(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(size, 1));
    if (size == 0) {
      all += "\xef\xbf\xbd";
    } else {
      all += is_control(character) ? " " : character;
    }
    text.remove_prefix(character.size());
  }
  return all;
}

/// Whether a spreadsheet would evaluate the cell. Some accept wide forms of the signs.
bool is_formula(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  constexpr std::string_view kSigns[] = {"=", "+", "-", "@", "\uff1d", "\uff0b", "\uff0d", "\uff20"};
  return std::ranges::any_of(kSigns, [text](std::string_view sign) { return text.starts_with(sign); });
}

std::string cell(std::string_view text) {
  std::string clean = plain(text);
  if (is_formula(clean)) clean.insert(clean.begin(), '\'');
  if (clean.find_first_of(",\"") == std::string::npos) return clean;
  std::string quoted = "\"";
  for (const char letter : clean) quoted.append(letter == '"' ? 2 : 1, letter);
  return quoted.append("\"");
}

/// Empty for null.
std::string cell(const codec::Value& value, codec::Cell form) {
  if (const auto* const text = std::get_if<std::string>(&value.is)) return cell(*text);
  if (const auto* const flag = std::get_if<bool>(&value.is)) return *flag ? "yes" : "no";
  if (const auto* const real = std::get_if<double>(&value.is))
    return form == codec::Cell::Time ? iso_time(*real) : icd::number_text(*real);
  const auto* const whole = std::get_if<std::int64_t>(&value.is);
  return whole == nullptr || (*whole == 0 && form == codec::Cell::NotZero) ? "" : std::to_string(*whole);
}

/// The members with a column, in column order.
std::vector<const codec::Member*> columns() {
  std::vector<const codec::Member*> all;
  for (const codec::Member& member : facts::ReportRow::kRow.members) {
    if (member.cell != codec::Cell::None) all.push_back(&member);
  }
  std::ranges::sort(all, {}, &codec::Member::column);
  return all;
}

/// A line of CSV: the result of `each` for each column. A nested row fills a column for each of its members.
std::string line(const auto& each) {
  std::string text;
  for (const codec::Member* const member : columns()) {
    const auto inner =
        member->kind->schema->row == nullptr ? std::span(member, 1) : member->kind->schema->row->members;
    for (const codec::Member& one : inner) text.append(text.empty() ? "" : ",").append(each(*member, one));
  }
  return text.append("\r\n");
}

std::string line(const codec::Value::Object& row) {
  return line([&row](const codec::Member& member, const codec::Member& inner) {
    const codec::Value& value = *codec::find_member(row, member.name);
    const auto* const members = std::get_if<codec::Value::Object>(&value.is);
    return cell(members == nullptr ? value : *codec::find_member(*members, inner.name), member.cell);
  });
}

}  // namespace

std::string csv_header() {
  return line([](const codec::Member&, const codec::Member& inner) { return inner.name; });
}

std::string csv_line(const facts::ReportRow& row) {
  return line(std::get<codec::Value::Object>(codec::json(row).is));
}

std::string iso_time(Time time) {
  static constexpr Time kYear10000 = 253402300800.0;
  if (!(time >= 0 && time < kYear10000)) return "";
  const auto seconds = static_cast<std::time_t>(time);
  const int milliseconds = static_cast<int>((time - std::floor(time)) * 1000);
  std::tm date{};
  if (gmtime_r(&seconds, &date) == nullptr) return "";
  char text[64];
  const int length =
      std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", date.tm_year + 1900,
                    date.tm_mon + 1, date.tm_mday, date.tm_hour, date.tm_min, date.tm_sec, milliseconds);
  return {text, static_cast<std::size_t>(length)};
}

}  // namespace adit::api
