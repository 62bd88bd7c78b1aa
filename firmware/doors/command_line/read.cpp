#include "command_line/read.hpp"

#include <getopt.h>

#include <algorithm>
#include <string_view>

#include "icd/suggestion.hpp"

namespace adit::command_line {
namespace {

constexpr int kFirst = 256;  // first number of a row for getopt_long; larger than any character

/// The rows for getopt_long, without those that lack "--".
std::vector<option> options_of(const Program& program) {
  std::vector<option> options;
  int number = kFirst;
  for (const Row& row : program.rows) {
    const bool is_option = std::string_view(row.word).starts_with("--");
    const int value = *row.value == '\0' ? no_argument : required_argument;
    if (is_option) options.push_back({row.word + 2, value, nullptr, number});
    ++number;
  }
  options.push_back({});
  return options;
}

std::string_view strip_dashes(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

/// An error about an unknown word, with a suggestion if a row's word is close.
std::string unknown(std::string_view word, const Program& program) {
  std::string sentence = std::string("unknown word '").append(word).append("'");
  std::vector<std::string_view> known;
  known.reserve(program.rows.size());
  for (const Row& row : program.rows) known.push_back(strip_dashes(row.word));
  const auto meant = icd::nearest(strip_dashes(word), known);
  if (!meant) return sentence;
  const auto row = std::ranges::find(known, *meant) - known.begin();
  return sentence.append("; did you mean ")
      .append(program.rows[static_cast<std::size_t>(row)].word)
      .append("?");
}

/// A value, and no option: "-1", "-.5".
bool is_negative_number(std::string_view word) {
  word.remove_prefix(word.starts_with('-') ? 1 : word.size());
  return !word.empty() && std::string_view("0123456789.").contains(word.front());
}

class CommandLineParser {
 public:
  explicit CommandLineParser(const Program& program) : program_(program), given_(program.rows.size()) {}

  Wrong words(std::span<const char* const> arguments) {
    // getopt_long needs the program's name first and null last. It changes no word and, because of "-", not
    // their order.
    std::vector<char*> all{const_cast<char*>(program_.name.c_str())};
    for (const char* const word : arguments) all.push_back(const_cast<char*>(word));
    const int count = static_cast<int>(all.size());
    all.push_back(nullptr);
    const std::vector<option> options = options_of(program_);
    optind = 0;  // restarts getopt_long after another command line
    opterr = 0;
    while (true) {
      const char* const at = all[static_cast<std::size_t>(std::max(optind, 1))];
      if (optind > 0 && optind < count && is_negative_number(at)) {
        ++optind;
        if (auto wrong = word(at)) return wrong;
        continue;
      }
      const int found = getopt_long(count, all.data(), "-:h", options.data(), nullptr);
      if (found == -1) break;
      if (auto wrong = apply_option(found, at)) return wrong;
    }
    for (; optind < count; ++optind) {
      if (auto wrong = word(all[static_cast<std::size_t>(optind)])) return wrong;
    }
    return missing();
  }

 private:
  /// `found`: getopt_long's result for the word `at`.
  Wrong apply_option(int found, std::string_view at) {
    if (found == 1) return word(optarg);
    if (found == 'h') return word("--help");
    const std::string name(at.substr(0, at.find('=')));
    const int number = found == '?' || found == ':' ? optopt : found;
    const Row* const row =
        number < kFirst ? nullptr : &program_.rows[static_cast<std::size_t>(number - kFirst)];
    if (row == nullptr || name != row->word)  // abbreviated words are not accepted
      return unknown(name, program_);
    if (found == '?') return name + " takes no value";
    if (found == ':') return name + " wants a value";
    return put(*row, optarg == nullptr ? "" : optarg);
  }

  Wrong word(const char* text) {
    const auto row = std::ranges::find_if(program_.rows, [text](const Row& each) {
      return *each.value == '\0' && std::string_view(each.word) == text;
    });
    if (row != program_.rows.end()) return put(*row, "");
    if (program_.word.take != nullptr) return program_.word.take(program_.word.into, text);
    return unknown(text, program_);
  }

  Wrong put(const Row& row, const std::string& value) {
    const std::string name = row.word;
    if (program_.given != nullptr) program_.given->push_back(name);
    if (*row.value != '\0' && value.empty() && program_.empty == EmptyValue::Rejected)
      return name + " wants a value";
    given_[static_cast<std::size_t>(&row - program_.rows.data())] = *row.value == '\0' || !value.empty();
    asked_ = asked_ || name == "--help" || name == "--version";
    if (auto* const flag = std::get_if<bool*>(&row.into)) **flag = true;
    if (auto* const text = std::get_if<std::string*>(&row.into)) **text = value;
    if (auto* const list = std::get_if<std::vector<std::string>*>(&row.into)) (*list)->push_back(value);
    if (const auto* const take = std::get_if<ValueSetter>(&row.into)) {
      if (const auto why = take->take(take->into, value)) return name + ": " + *why;
    }
    return std::nullopt;
  }

  Wrong missing() const {
    for (std::size_t i = 0; i < given_.size() && !asked_; ++i) {
      const Row& row = program_.rows[i];
      if (row.wanted == Presence::Required && !given_[i])
        return std::string(row.word) + " " + row.value + " is missing";
    }
    return std::nullopt;
  }

  const Program& program_;
  std::vector<bool> given_;  // by row
  bool asked_ = false;       // for help or the version: required options may be missing
};

}  // namespace

Wrong read(const Program& program, std::span<const char* const> arguments) {
  return CommandLineParser(program).words(arguments);
}

}  // namespace adit::command_line
