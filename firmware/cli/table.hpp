#pragma once

#include <string>
#include <vector>

#include "cli/words.hpp"

namespace adit::cli {

struct Cell {
  std::string text;
  Tone tone = Tone::Plain;
};

/// Rows of cells in aligned columns. What others wrote is escaped on the way in.
class Table {
 public:
  enum class Align : std::uint8_t { Left, Right };
  struct Column {
    std::string name;
    Align align = Align::Left;
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// As many cells as there are columns.
  void add(std::vector<Cell> cells);
  bool empty() const { return rows_.empty(); }

  /// With a line of names above, unless all of them are empty; each line begins with two spaces.
  std::string written(bool colour) const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// Lines of a name and its value.
class Facts {
 public:
  /// Adds no line if `text` is empty.
  void add(const char* name, const std::string& text, Tone tone = Tone::Plain);
  std::string written(bool colour) const { return table_.written(colour); }

 private:
  Table table_{{{}, {}}};
};

}  // namespace adit::cli
