#pragma once

#include <string>
#include <vector>

#include "cli/words.hpp"

namespace adit::cli {

struct Cell {
  std::string text;
  Tone tone = Tone::Plain;
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
  std::string written(bool colour) const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// Lines of a name and a value.
class Facts {
 public:
  /// Skips an empty `text`.
  void add(const char* name, const std::string& text, Tone tone = Tone::Plain);
  std::string written(bool colour) const { return table_.written(colour); }

 private:
  Table table_{{{}, {}}};
};

}  // namespace adit::cli
