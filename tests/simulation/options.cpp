#include "simulation/options.hpp"

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string_view>

namespace adit::simulation {
namespace {

bool set_flag(Options& options, std::string_view word) {
  bool* const flag = word == "--log"        ? &options.log
                     : word == "--story"    ? &options.story
                     : word == "--as-it-is" ? &options.as_it_is
                                            : nullptr;
  if (flag != nullptr) *flag = true;
  return flag != nullptr;
}

bool set(Options& options, std::string_view word, const char* value) {
  const auto number = [value] { return std::strtoull(value, nullptr, 10); };
  if (word == "--seed") {
    options.seed = number();
  } else if (word == "--runs") {
    options.runs = number();
  } else if (word == "--jobs") {
    options.jobs = std::max<std::uint64_t>(1, number());
  } else if (word == "--hours") {
    options.hours = std::strtod(value, nullptr);
  } else if (word == "--cpu") {
    options.cpu = std::strtod(value, nullptr);
  } else if (word == "--until") {
    options.until = value;
  } else if (word == "--without") {
    options.without = Omissions(value);
  } else {
    return false;
  }
  return true;
}

}  // namespace

std::optional<Options> read_options(int argc, char** argv) {
  Options options;
  options.seed = std::random_device{}();
  bool runs = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (set_flag(options, word)) continue;
    if (++i == argc || !set(options, word, argv[i])) return std::nullopt;
    runs = runs || word == "--runs";
  }
  if (!runs && (options.hours > 0 || options.cpu > 0)) options.runs = UINT64_MAX;
  return options;
}

}  // namespace adit::simulation
