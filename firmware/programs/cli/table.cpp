#include "cli/table.hpp"

#include <algorithm>
#include <utility>

#include "host/log.hpp"

namespace adit::cli {
namespace {

std::string row_text(const std::vector<Cell>& cells, const std::vector<Table::Column>& columns,
                     const std::vector<std::size_t>& widths, bool colour) {
  std::string text;
  std::size_t owed = 0;  // spaces written only before visible text, so that lines have none at their ends
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t spare = widths[i] - width_of(cells[i].text);
    const bool right = columns[i].align == Table::Align::Right;
    owed += 2 + (right ? spare : 0);
    if (!cells[i].text.empty()) {
      text.append(std::exchange(owed, 0), ' ').append(painted(cells[i].text, cells[i].tone, colour));
    }
    owed += right ? 0 : spare;
  }
  return text + '\n';
}

}  // namespace

void Table::add(std::vector<Cell> cells) {
  for (Cell& cell : cells) cell.text = host::escaped(cell.text);
  rows_.push_back(std::move(cells));
}

std::string Table::written(bool colour) const {
  std::vector<Cell> names;
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) {
    names.push_back({column.name, Tone::Faint});
    widths.push_back(width_of(column.name));
  }
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i].text));
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
