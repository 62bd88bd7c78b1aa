#include "icd/sentence.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <ctime>
#include <iterator>

#include "icd/text.hpp"

namespace adit::icd {
namespace {

constexpr std::size_t kMostQuoted = 40;

struct Escape {
  char character;
  std::string_view text;
};
constexpr Escape kInHtml[] = {{'&', "&amp;"},  {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"},
                              {'\'', "&#39;"}, {'\n', " "},   {'\t', " "}};

}  // namespace

std::string number_text(double number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  return {digits.data(), end};
}

std::string real_text(double number) {
  const std::string text = number_text(number);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;  // n: nan and inf
}

std::string size_text(std::uint64_t bytes) {
  constexpr std::uint64_t kKilobyte = 1000, kMegabyte = 1'000'000;
  if (bytes < kKilobyte) return sentence(bytes, " B");
  if (bytes < kMegabyte - kKilobyte / 2) return sentence((bytes + kKilobyte / 2) / kKilobyte, " kB");
  const std::uint64_t tenths = (bytes / (kMegabyte / 20) + 1) / 2;
  return tenths % 10 == 0 ? sentence(tenths / 10, " MB") : sentence(tenths / 10, ".", tenths % 10, " MB");
}

std::string quote_text(std::string_view text) {
  const bool cut = text.size() > kMostQuoted;
  std::string quote = "\"";
  for (const char byte : beginning_of(text, kMostQuoted)) {
    const auto code = static_cast<std::uint8_t>(byte);
    quote += code < 0x20 || code == 0x7f ? '?' : byte;
  }
  quote += cut ? "...\"" : "\"";
  return quote;
}

std::string escape_html(std::string_view text) {
  std::string all;
  all.reserve(text.size());
  for (const char c : text) {
    const auto* const escape = std::ranges::find(kInHtml, c, &Escape::character);
    if (escape != std::end(kInHtml)) {
      all += escape->text;
    } else {
      all += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? "\uFFFD" : std::string(1, c);
    }
  }
  return all;
}

std::string utc(double seconds) {
  constexpr double kMost = 1e11;
  if (!(seconds > 0 && seconds <= kMost)) return "";
  const auto whole = static_cast<std::time_t>(seconds);
  std::tm parts{};
  char text[32];
  if (gmtime_r(&whole, &parts) == nullptr) return "";
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts)};
}

}  // namespace adit::icd
