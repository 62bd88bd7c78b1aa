#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::cli {

/// Emphasis of a text, never the only carrier of its meaning.
enum class Tone : std::uint8_t { Plain, Faint, Strong, Good, Warning, Bad };

/// Applies the tone's colour if `colour`.
std::string paint(const std::string& text, Tone tone, bool colour);

/// A line of strings and numbers, escaped.
template <class... Parts>
std::string line(const Parts&... parts) {
  return host::escape(icd::sentence(parts...)) + '\n';
}

/// "0.4 s", "12 s", "3 min", "2 h"
std::string duration(double seconds);
/// Run time: "1:02:03", "12:34"
std::string clock(double seconds);
/// A Command Post's answer: "accepted", "error 422: its sentence", or only a sentence that ends with the
/// status; "" without an answer.
std::string answer_of(int status, const std::string& sentence);
/// At most `digits` decimals, without trailing zeros.
std::string decimal(double number, int digits);

struct Cell {
  Cell(std::string shown = "", Tone tone_of_it = Tone::Plain) : text(std::move(shown)), tone(tone_of_it) {}
  std::string text;
  Tone tone;
};

/// Rows of cells in aligned columns. Escapes all text.
class Table {
 public:
  enum class Align : std::uint8_t { Left, Right };
  struct Column {
    std::string name;
    Align align = Align::Left;
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// One cell for each column.
  void add(std::vector<Cell> cells);
  bool empty() const { return rows_.empty(); }

  /// With a heading, unless all names are empty. Each line begins with two spaces.
  std::string to_text(bool colour) const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

inline constexpr auto kRight = Table::Align::Right;

/// A column of a table with a row for each item.
template <class Item>
struct ColumnOf {
  const char* name;
  std::function<Cell(const Item& item)> cell;
  Table::Align align = Table::Align::Left;
};

/// The table as Table::to_text(), or "" without items.
template <class Item>
std::string table_of(const std::vector<Item>& items, const std::vector<ColumnOf<Item>>& columns,
                     bool colour) {
  std::vector<Table::Column> heading;
  heading.reserve(columns.size());
  for (const auto& column : columns) heading.push_back({column.name, column.align});
  Table table(std::move(heading));
  for (const Item& item : items) {
    std::vector<Cell> cells;
    cells.reserve(columns.size());
    for (const auto& column : columns) cells.push_back(column.cell(item));
    table.add(std::move(cells));
  }
  return table.empty() ? "" : table.to_text(colour);
}

/// Lines of a name and a value.
class Facts {
 public:
  /// Skips an empty `text`.
  void add(const char* name, const std::string& text, Tone tone = Tone::Plain);
  std::string to_text(bool colour) const { return table_.to_text(colour); }

 private:
  Table table_{{{}, {}}};
};

}  // namespace adit::cli
