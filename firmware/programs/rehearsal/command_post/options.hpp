#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "command_line/program.hpp"
#include "rehearsal/command_post/fields.hpp"
#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/run.hpp"
#include "rehearsal/command_post/server.hpp"

namespace adit::rehearsal {

/// What the command line says.
struct Options {
  Address scoring;
  Address mapping;
  std::optional<Address> control;
  std::string secrets;
  std::string artifacts;   // "": none
  std::string transcript;  // "": none
  std::uint64_t transcript_bytes = 2'000'000'000;
  Manner manner = Manner::Strict;
  bool slash = false;           // each path has to end with one
  bool serial = false;          // each endpoint serves one connection at a time
  std::size_t limit_bytes = 0;  // of a body; 0: only the endpoints' own limits
  RunPlan run;
  std::optional<double> rate;            // Hz; absent: by the manner
  bool one_api_limit = false;            // over statuses and reports together
  std::optional<Counted> counted;        // how the mapping rate is measured; absent: by the manner
  double link = 0;                       // Mbit/s over both endpoints; 0: no limit
  std::vector<std::string> roster;       // the robots' names; empty: any
  std::vector<std::string> faults;       // "reports:record-then-drop", not yet understood
  std::vector<std::string> fault_rates;  // "reports:record-then-drop=0.1", not yet understood
  std::uint64_t seed = 1;                // of what happens at random
  bool not_started = false;
  bool verbose = false;
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);

/// The tokens that the two endpoints know the team by.
struct Secrets {
  std::string scoring;
  std::string mapping;
};

/// `scoring.token` and `mapping.token` in `folder`; white space around a token is cut. An error names the
/// file, never its content.
std::expected<Secrets, std::string> read_secrets(const std::string& folder);

}  // namespace adit::rehearsal
