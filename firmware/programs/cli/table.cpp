#include "cli/table.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "host/log.hpp"
#include "icd/text.hpp"

namespace adit::cli {
namespace {

/// ECMA-48 8.3.117 (SGR), in the order of Tone.
constexpr const char* kCodes[] = {"", "\033[2m", "\033[1m", "\033[32m", "\033[33m", "\033[1;31m"};

constexpr double kLongestTime = 1e9;  // seconds; a larger value is an error of the peer

}  // namespace

std::string paint(const std::string& text, Tone tone, bool colour) {
  if (!colour || tone == Tone::Plain || text.empty()) return text;
  return kCodes[static_cast<std::size_t>(tone)] + text + "\033[0m";
}

std::string duration(double seconds) {
  const double time = std::clamp(seconds, 0.0, kLongestTime);
  if (time < 9.95) return decimal(time, 1) + " s";
  if (time < 99.5) return decimal(time, 0) + " s";
  if (time < 5970) return decimal(time / 60, 0) + " min";
  return decimal(time / 3600, 0) + " h";
}

std::string clock(double seconds) {
  const auto whole = static_cast<long>(std::clamp(seconds, 0.0, kLongestTime));
  char text[32];
  int length = 0;
  if (whole < 3600) {
    length = std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  } else {
    length = std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return {text, static_cast<std::size_t>(length)};
}

std::string answer_of(int status, const std::string& sentence) {
  if (status == 0 || sentence.ends_with(std::to_string(status))) return sentence;
  const std::string answer = status < 300 ? "accepted" : "error " + std::to_string(status);
  return sentence.empty() ? answer : answer + ": " + sentence;
}

std::string decimal(double number, int digits) {
  char text[400];
  const int length = std::snprintf(text, sizeof text, "%.*f", digits, number);
  std::string written(text, static_cast<std::size_t>(length));
  if (written.find('.') != std::string::npos) {
    written.erase(written.find_last_not_of('0') + 1);
    if (written.ends_with('.')) written.pop_back();
  }
  return written == "-0" ? "0" : written;
}

namespace {

std::string row_text(const std::vector<Cell>& cells, const std::vector<Table::Column>& columns,
                     const std::vector<std::size_t>& widths, bool colour) {
  std::string text;
  std::size_t owed = 0;  // spaces written only before visible text, so that lines have none at their ends
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t spare = widths[i] - icd::count_characters(cells[i].text);
    const bool right = columns[i].align == Table::Align::Right;
    owed += 2 + (right ? spare : 0);
    if (!cells[i].text.empty()) {
      text.append(std::exchange(owed, 0), ' ').append(paint(cells[i].text, cells[i].tone, colour));
    }
    owed += right ? 0 : spare;
  }
  return text + '\n';
}

}  // namespace

void Table::add(std::vector<Cell> cells) {
  for (Cell& cell : cells) cell.text = host::escape(cell.text);
  rows_.push_back(std::move(cells));
}

std::string Table::to_text(bool colour) const {
  std::vector<Cell> names;
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) {
    names.push_back({column.name, Tone::Faint});
    widths.push_back(icd::count_characters(column.name));
  }
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], icd::count_characters(row[i].text));
  }
  const bool named = std::ranges::any_of(columns_, [](const Column& column) { return !column.name.empty(); });
  std::string text = named ? row_text(names, columns_, widths, colour) : "";
  for (const auto& row : rows_) text += row_text(row, columns_, widths, colour);
  return text;
}

void Facts::add(const char* name, const std::string& text, Tone tone) {
  if (!text.empty()) table_.add({{name, Tone::Faint}, {text, tone}});
}

}  // namespace adit::cli
