#pragma once

#include <gmock/gmock.h>

#include <string_view>
#include <vector>

#include "cli/commands.hpp"
#include "cli/server.hpp"
#include "cli/token_file.hpp"

namespace adit::cli {

/// Runs `adit` with these words against the server, with a token. The outcome has all output.
inline Outcome run_adit(const Server& server, std::vector<std::string_view> words, Console console = {}) {
  const TokenFile token;
  const std::string at = server.at();
  words.insert(words.end(), {"--at", at, "--token-file", token.path()});
  std::string printed;
  console.print = [&printed](const std::string& text) { printed += text; };
  Outcome outcome = run(words, console);
  outcome.out.insert(0, printed);
  EXPECT_THAT(outcome.out + outcome.err, testing::Not(testing::HasSubstr("sesame")))
      << "the output contains the token";
  return outcome;
}

inline std::string help_of(std::string_view command) {
  return run(std::vector<std::string_view>{"help", command}).out;
}

/// A console whose operator answers `answer`; `asked` gets the question.
inline Console answering(bool answer, std::string& asked) {
  return {.ask = [answer, &asked](const std::string& question) {
    asked = question;
    return std::optional(answer);
  }};
}

}  // namespace adit::cli
