#include "settings/board.hpp"

#include <algorithm>

#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "settings/reader.hpp"

namespace adit::settings {
namespace {

using codec::Value;

constexpr std::size_t kLongestName = 32, kLongestTitle = 80;

/// Also the name of the board's directory.
bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= kLongestName && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

bool is_title(const std::string& text) {
  return !text.empty() && text.size() <= kLongestTitle &&
         std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

class BoardReader {
 public:
  void read(const Value::Object& members) {
    for (const auto& [name, value] : members) {
      if (std::ranges::find(seen_, name) != seen_.end()) {
        reader.errors.push_back({name, "given twice"});
      } else {
        read_member(name, value);
      }
    }
    for (const char* const name : {"name", "title"}) {
      if (std::ranges::find(seen_, name) == seen_.end()) reader.errors.push_back({name, "missing"});
    }
    if (reader.errors.empty() && board.panel) check_panel(*board.panel, reader.errors);
  }

  Board board;
  Reader reader;

 private:
  void read_member(const std::string& name, const Value& value) {
    static const std::vector<Child> kChildren = {{"name"}, {"title"}, {"panel"}};
    if (std::ranges::find(kChildren, name, &Child::name) == kChildren.end()) {
      return reader.tell_unknown(name, kChildren, "");
    }
    seen_.push_back(name);
    if (name == "name") {
      read_text(board.name, is_name, name, value,
                icd::sentence("1 to ", kLongestName, " small letters, digits, hyphens and underscores"));
    } else if (name == "title") {
      read_text(board.title, is_title, name, value,
                icd::sentence("1 to ", kLongestTitle, " printable ASCII characters"));
    } else {
      reader.read_object(value, "panel", "panel");
      board.panel = reader.settings.panel;
    }
  }

  void read_text(std::string& member, bool (*fits)(const std::string&), const std::string& path,
                 const Value& value, const std::string& expected) {
    const auto* const text = std::get_if<std::string>(&value.is);
    if (text != nullptr && fits(*text)) {
      member = *text;
    } else {
      reader.errors.push_back({path, icd::sentence("expected ", expected, ", got ", shown(value))});
    }
  }

  std::vector<std::string> seen_;
};

}  // namespace

std::expected<Board, std::vector<Error>> parse_board(std::string_view json) {
  const auto root = ADIT_TRY(read_json(json));
  const auto* const members = std::get_if<Value::Object>(&root.is);
  if (members == nullptr) {
    return std::unexpected(std::vector<Error>{{"", "expected an object, got " + shown(root)}});
  }
  BoardReader board;
  board.read(*members);
  if (!board.reader.errors.empty()) return std::unexpected(std::move(board.reader.errors));
  return std::move(board.board);
}

}  // namespace adit::settings
