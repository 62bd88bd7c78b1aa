#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace adit::command_line {

/// What is wrong; nothing: it is right.
using Wrong = std::optional<std::string>;

/// Takes the value of an option, "" of one that stands alone. As plain as the rows are, which are many.
struct Take {
  Wrong (*take)(void* into, const std::string& value) = nullptr;
  void* into = nullptr;
};

/// That which calls TakeInto(Into&, value).
template <auto TakeInto, class Into>
Take take(Into& into) {
  return {[](void* known, const std::string& value) -> Wrong {
            return TakeInto(*static_cast<Into*>(known), value);
          },
          &into};
}

/// Whether an option may be left out, and whether its value may be "".
enum class Wanted : std::uint8_t { Maybe, Always };
enum class Empty : std::uint8_t { Refused, Taken };

/// One option: all that reads, explains, documents or completes it comes from here.
struct Row {
  const char* word;   // "--settings"; or a word of its own, "good"
  const char* value;  // what the help calls it, "FILE", "N|all"; "": it stands alone
  const char* help;   // what it is for; a text that it has where it is left out is added to that
  std::variant<bool*, std::string*, std::vector<std::string>*, Take> into;
  Wanted wanted = Wanted::Maybe;
};

/// A program's command line. Of an option that comes twice the last counts.
struct Program {
  std::string name;
  std::string usage;  // the words after it, but for the options; "": none
  std::string about;  // what it does, a paragraph a line; one that begins with a blank is kept as it is
  std::vector<Row> rows;
  std::string ending;  // what else is to be known, as `about`
  Empty empty = Empty::Refused;
  std::vector<std::string>* given = nullptr;  // gets the words of the rows that came; null: nobody asks
  Take word = {};                             // takes each word that is no row's; null: there is none
};

/// What --help prints. It and all that reads a command line is cold: run once, it is to be small.
[[gnu::cold]] std::string help(const Program& program);

}  // namespace adit::command_line
