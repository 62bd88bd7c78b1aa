#pragma once

#include <sys/types.h>

#include <chrono>

#include "client.hpp"
#include "command_line/read.hpp"

namespace adit::bench {

/// One way to the Command Post: `name=port`, and `:pid` of the program in between.
struct Way {
  std::string name;
  std::uint16_t port = 0;
  pid_t process = 0;
};

struct Options {
  Kind what = Kind::Reports;
  std::size_t messages = 2000;  // on each way
  std::chrono::seconds most{600};
  std::chrono::milliseconds pace{5};  // from the start of one to the start of the next
  std::size_t block = 20;             // messages on one way before the next has its turn
  std::string flush;                  // the ledger's folder
  std::string token;
  std::vector<Way> ways;  // the first without anything in between
  bool help = false;
};

command_line::Program command_line_of(Options& options);
std::expected<Options, std::string> parse_options(std::span<const char* const> arguments);

}  // namespace adit::bench
