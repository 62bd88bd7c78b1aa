#include "simulation/omissions.hpp"

#include <charconv>

namespace adit::simulation {
namespace {

std::uint64_t number_in(std::string_view text) {
  std::uint64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

void append(std::string& words, const std::string& word) {
  words.append(words.empty() ? "" : ",").append(word);
}

}  // namespace

Omissions::Omissions(std::string_view words) {
  while (!words.empty()) {
    const auto end = words.find(',');
    read(words.substr(0, end));
    words = end == words.npos ? std::string_view() : words.substr(end + 1);
  }
}

void Omissions::read(std::string_view word) {
  const auto slash = word.rfind('/');
  const std::string actor(word.substr(0, slash));
  if (slash == word.npos) return add_all(actor);
  const std::string_view range = word.substr(slash + 1);
  const auto dash = range.find('-');
  const std::uint64_t first = number_in(range);
  add(actor, first, dash == range.npos ? first : number_in(range.substr(dash + 1)));
}

bool Omissions::has(const std::string& actor, std::uint64_t number) const {
  if (whole_.contains(actor)) return true;
  const auto numbers = numbers_.find(actor);
  return numbers != numbers_.end() && numbers->second.contains(number);
}

void Omissions::add(const std::string& actor, std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t number = first; number <= last; ++number) numbers_[actor].insert(number);
}

std::string Omissions::words() const {
  std::string words;
  for (const std::string& actor : whole_) append(words, actor);
  for (const auto& [actor, numbers] : numbers_) {
    if (whole_.contains(actor)) continue;
    for (auto each = numbers.begin(); each != numbers.end();) {
      const std::uint64_t first = *each;
      std::uint64_t last = first;
      while (++each != numbers.end() && *each == last + 1) ++last;
      const std::string range = std::to_string(first) + (last > first ? '-' + std::to_string(last) : "");
      append(words, actor + '/' + range);
    }
  }
  return words;
}

}  // namespace adit::simulation
