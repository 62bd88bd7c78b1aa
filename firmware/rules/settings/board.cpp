#include "settings/board.hpp"

#include <algorithm>

#include "codec/row.hpp"
#include "icd/try.hpp"
#include "settings/reader.hpp"

namespace adit::settings {
namespace {

using codec::Form;
using codec::member;

/// Also the name of the board's directory.
constexpr Form kName{[](std::string_view text) {
                       return !text.empty() && text.size() <= 32 && std::ranges::all_of(text, [](char c) {
                         return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
                       });
                     },
                     "1 to 32 small letters, digits, hyphens and underscores"};
constexpr Form kTitle{[](std::string_view text) {
                        return !text.empty() && text.size() <= 80 &&
                               std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
                      },
                      "1 to 80 printable ASCII characters"};

constexpr codec::Member kBoard[] = {
    member<&Board::name>("name").matching(kName),
    member<&Board::title>("title").matching(kTitle),
    member<&Board::panel>("panel").optional(),
};

}  // namespace

constexpr codec::Row Board::kRow = codec::complete<Board>({"", kBoard});

std::expected<Board, std::vector<Error>> parse_board(std::string_view json) {
  const auto root = ADIT_TRY(read_json(json));
  Board board;
  Reader reader;
  reader.read_object(root, Board::kRow, &board, "");
  if (reader.errors.empty() && board.panel) check_panel(*board.panel, reader.errors);
  if (!reader.errors.empty()) return std::unexpected(std::move(reader.errors));
  return board;
}

}  // namespace adit::settings
