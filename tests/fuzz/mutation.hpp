#pragma once

#include <random>
#include <string>
#include <vector>

namespace adit::fuzz {

/// Other inputs than the seeds, the same ones for the same `random` on every machine: bytes of a seed
/// changed, taken out, repeated, or replaced by some of another seed or by a word of the dictionary.
class Mutation {
 public:
  Mutation(std::vector<std::string> seeds, std::vector<std::string> words, unsigned seed)
      : seeds_(std::move(seeds)), words_(std::move(words)), random_(seed) {}

  std::string next();

 private:
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }
  std::string piece_of(const std::string& text);
  void change(std::string& input);

  std::vector<std::string> seeds_, words_;
  std::mt19937 random_;
};

}  // namespace adit::fuzz
