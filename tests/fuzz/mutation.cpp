#include "mutation.hpp"

#include <algorithm>

namespace adit::fuzz {

std::string Mutation::piece_of(const std::string& text) {
  const std::size_t at = below(text.size());
  return text.substr(at, 1 + below(64));
}

void Mutation::change(std::string& input) {
  constexpr char kOdd[] = {'\0', '\x01', '\x7f', '\x80', '\xff', ' ', '0', '9'};
  const std::size_t at = below(input.size() + 1), size = below(input.size() - at + 1);
  switch (below(8)) {
    case 0:
      if (at < input.size()) input[at] = static_cast<char>(input[at] ^ (1U << below(8)));
      break;
    case 1:
      if (at < input.size()) input[at] = kOdd[below(sizeof kOdd)];
      break;
    case 2:
      input.insert(at, 1, static_cast<char>(below(256)));
      break;
    case 3:
      input.erase(at, 1 + below(16));
      break;
    case 4:
      input.insert(at, piece_of(input));
      break;
    case 5:
      input.replace(at, std::min(size, below(64)), piece_of(seeds_[below(seeds_.size())]));
      break;
    case 6:
      input.insert(at, words_.empty() ? "" : words_[below(words_.size())]);
      break;
    default:
      if (below(4) == 0) input.resize(at);
  }
}

std::string Mutation::next() {
  std::string input = seeds_[below(seeds_.size())];
  for (std::size_t times = 1 + below(4); times > 0; --times) change(input);
  return input;
}

}  // namespace adit::fuzz
