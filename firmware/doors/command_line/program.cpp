#include "command_line/program.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "icd/text.hpp"

namespace adit::command_line {
namespace {

constexpr std::size_t kWidth = 100;

/// Wraps a line at kWidth. All lines but the first are indented by `indent` blanks.
std::string wrap_line(std::string_view line, std::size_t indent) {
  std::string all(icd::cut(line, ' '));
  std::size_t column = indent + all.size();
  while (!line.empty()) {
    const std::string_view word = icd::cut(line, ' ');
    const bool fits = column + 1 + word.size() <= kWidth;
    all.append(fits ? "" : "\n").append(fits ? 1 : indent, ' ').append(word);
    column = (fits ? column + 1 : indent) + word.size();
  }
  return all;
}

/// Wraps each line, except those that begin with a blank.
std::string paragraphs(std::string_view text) {
  std::string all;
  while (!text.empty()) {
    const std::string_view line = icd::cut(text, '\n');
    all.append(line.starts_with(' ') ? std::string(line) : wrap_line(line, 0)).append("\n");
  }
  return all;
}

std::string head_of(const Row& row) {
  std::string head = row.word;
  return *row.value == '\0' ? head : head.append(" ").append(row.value);
}

std::string sentence_of(const Row& row) {
  std::string sentence = row.help;
  const auto* const text = std::get_if<std::string*>(&row.into);
  if (text != nullptr && !(*text)->empty()) sentence.append(" (").append(**text).append(")");
  return sentence;
}

}  // namespace

std::string help(const Program& program) {
  std::string text = "Usage: ";
  text += program.name;
  std::size_t column = 0;
  for (const Row& row : program.rows) {
    column = std::max(column, head_of(row).size() + 4);
    if (row.wanted == Presence::Required) text.append(" ").append(head_of(row));
  }
  if (!program.usage.empty()) text.append(" ").append(program.usage);
  text.append(" [OPTION]...\n\n").append(paragraphs(program.about)).append("\n");
  for (const Row& row : program.rows) {
    std::string head = "  ";
    head.append(head_of(row)).resize(column, ' ');
    text.append(head).append(wrap_line(sentence_of(row), column)).append("\n");
  }
  return text.append("\n").append(paragraphs(program.ending));
}

namespace {

template <class Number>
Wrong read(const std::string& text, Number least, Number most, Number& number) {
  const char* const past = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), past, number);
  if (error == std::errc() && end == past && number >= least && number <= most) return std::nullopt;
  const auto written = [](Number bound) {
    char digits[64];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, bound).ptr);
  };
  return "expected " + written(least) + " to " + written(most) + ", got '" + text + "'";
}

}  // namespace

Wrong read_number(const std::string& text, double least, double most, double& number) {
  return read(text, least, most, number);
}
Wrong read_number(const std::string& text, std::uint64_t least, std::uint64_t most, std::uint64_t& number) {
  return read(text, least, most, number);
}

}  // namespace adit::command_line
