// The targets without libFuzzer: each seed, and a fixed number of inputs made of them, the same ones each
// time. CI's short turn.
//   adit_fuzz FOLDER [--runs N] [TARGET...]
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "mutation.hpp"
#include "targets.hpp"

namespace adit::fuzz {
namespace {

namespace fs = std::filesystem;

const Target* under_way = nullptr;
const std::string* input_under_way = nullptr;

/// Keeps the input that ended the program.
void keep_input(int signal) {
  const std::string file = std::string("fuzz-failed-") + under_way->name;
  std::ofstream(file, std::ios::binary) << *input_under_way;
  std::fprintf(stderr, "%s: the input is in %s\n", under_way->name, file.c_str());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<std::string> read_seeds(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);  // however the file system has them
  std::vector<std::string> seeds;
  for (const fs::path& path : files) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

std::string unescaped(std::string_view text) {
  std::string word;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool is_hex = text.substr(at).starts_with("\\x") && at + 3 < text.size();
    if (is_hex) word += static_cast<char>(std::stoi(std::string(text.substr(at + 2, 2)), nullptr, 16));
    if (!is_hex) word += text[at] == '\\' ? text[++at] : text[at];
    if (is_hex) at += 3;
  }
  return word;
}

/// libFuzzer's format: a word in quotation marks on each line.
std::vector<std::string> read_dictionary(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> words;
  for (std::string line; std::getline(file, line);) {
    const auto first = line.find('"'), last = line.rfind('"');
    if (line.starts_with('#') || first == last) continue;
    words.push_back(unescaped(std::string_view(line).substr(first + 1, last - first - 1)));
  }
  return words;
}

void play(const Target& target, const fs::path& folder, int runs) {
  under_way = &target;
  const auto seeds = read_seeds(folder / "seeds" / target.name);
  Mutation mutation(seeds, read_dictionary(folder / (std::string(target.name) + ".dict")), 1);
  const auto run = [&target](const std::string& input) {
    input_under_way = &input;
    target.try_input(input);
  };
  std::ranges::for_each(seeds, run);
  for (int i = 0; i < runs; ++i) run(mutation.next());
  std::printf("%-10s %3zu seeds, %6d inputs made of them\n", target.name, seeds.size(), runs);
}

int play_all(const fs::path& folder, std::vector<std::string> names, int runs) {
  for (const std::string& name : names) {
    if (target_named(name) == nullptr) return std::fprintf(stderr, "%s: no target\n", name.c_str()), 1;
  }
  for (const Target& target : targets()) {
    const bool is_asked = names.empty() || std::ranges::find(names, target.name) != names.end();
    if (is_asked) play(target, folder, runs < 0 ? target.short_turn : runs);
  }
  return 0;
}

}  // namespace
}  // namespace adit::fuzz

int main(int count, char** words) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::signal(SIGABRT, adit::fuzz::keep_input);
  std::vector<std::string> names;
  int runs = -1;
  if (count < 2) return std::fprintf(stderr, "usage: adit_fuzz FOLDER [--runs N] [TARGET...]\n"), 1;
  for (int i = 2; i < count; ++i) {
    if (std::strcmp(words[i], "--runs") == 0 && i + 1 < count) {
      runs = std::atoi(words[++i]);
    } else {
      names.emplace_back(words[i]);
    }
  }
  return adit::fuzz::play_all(words[1], names, runs);
}
