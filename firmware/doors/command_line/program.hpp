#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace adit::command_line {

/// An error, or nullopt.
using Wrong = std::optional<std::string>;

/// Stores an option's value, or "" if it takes none, in `into`. Plain pointers keep the many rows small.
struct ValueSetter {
  Wrong (*take)(void* into, const std::string& value) = nullptr;
  void* into = nullptr;
};

/// Stores a value by TakeInto(Into&, value).
template <auto TakeInto, class Into>
ValueSetter set_by(Into& into) {
  return {[](void* known, const std::string& value) -> Wrong {
            return TakeInto(*static_cast<Into*>(known), value);
          },
          &into};
}

/// Whether an option may be omitted, and whether its value may be "".
enum class Presence : std::uint8_t { Optional, Required };
enum class EmptyValue : std::uint8_t { Rejected, Accepted };

/// One option. Reading, help, documents and completion are made from it.
struct Row {
  const char* word;   // "--settings", or a plain word: "good"
  const char* value;  // its name in the help, "FILE", "N|all"; "": it has no value
  const char* help;   // its purpose; a default text in `into` is appended
  std::variant<bool*, std::string*, std::vector<std::string>*, ValueSetter> into;
  Presence wanted = Presence::Optional;
};

/// A program's command line. If an option is repeated, the last value counts, but a list gets all values.
struct Program {
  std::string name;
  std::string usage = "";  // the words after the name, without options
  std::string about;  // its purpose, one paragraph per line; a line that begins with a blank is not wrapped
  std::vector<Row> rows;
  std::string ending = "";  // further information, formatted like `about`
  EmptyValue empty = EmptyValue::Rejected;
  std::vector<std::string>* given = nullptr;  // gets the words of the options that were given; may be null
  ValueSetter word = {};  // stores each word that matches no row; null: such words are errors
};

/// The text of --help. This function and read() are cold: they run once and should be small.
[[gnu::cold]] std::string help(const Program& program);

/// nullopt if `text` is a number from `least` to `most`, which is then in `number`.
[[gnu::cold]] Wrong read_number(const std::string& text, double least, double most, double& number);
[[gnu::cold]] Wrong read_number(const std::string& text, std::uint64_t least, std::uint64_t most,
                                std::uint64_t& number);

/// Stores a number from Least to Most in `into`. It must be whole if Least is an integer.
template <auto Least, decltype(Least) Most, class Into>
ValueSetter number(Into& into) {
  return set_by<[](Into& place, const std::string& text) {
    std::conditional_t<std::is_integral_v<decltype(Least)>, std::uint64_t, double> number = 0;
    auto wrong = read_number(text, Least, Most, number);
    if (!wrong) place = Into(number);
    return wrong;
  }>(into);
}

}  // namespace adit::command_line
