#include "host/output.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>

#include "host/folder.hpp"

namespace adit::host {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Output, HasBothStreams) {
  const Output said =
      output_of({"/bin/sh", "-c", "echo one; echo two >&2; printf three"}, milliseconds(20000));
  EXPECT_EQ(said.out, "one\nthree");
  EXPECT_EQ(said.err, "two\n");
  EXPECT_EQ(said.trouble, "");
}

TEST(Output, ArrivesLineByLine) {
  const Folder folder;
  const std::string waits = "echo one; until [ -e " + folder / "heard" + " ]; do sleep 0.02; done; ";
  std::vector<std::string> lines;
  output_of({"/bin/sh", "-c", waits + "printf 'two\\n\\nthr'"}, milliseconds(20000),
            [&](std::string_view line) {
              lines.emplace_back(line);
              folder.put("heard", "");
            });
  EXPECT_THAT(lines, ElementsAre("one", "two", ""));
}

TEST(Output, TellsHowAProgramFailed) {
  EXPECT_EQ(output_of({"/bin/sh", "-c", "exit 3"}, milliseconds(20000)).trouble, "exit status 3");
  EXPECT_EQ(output_of({"/bin/sh", "-c", "kill -9 $$"}, milliseconds(20000)).trouble, "ended by signal 9");
  EXPECT_THAT(output_of({"/no/such"}, milliseconds(20000)).trouble, StartsWith("No such file"));
  const Output slow = output_of({"/bin/sh", "-c", "echo begun; exec sleep 30"}, milliseconds(1000));
  EXPECT_EQ(slow.trouble, "took longer than 1000 ms");
  EXPECT_EQ(slow.out, "begun\n");
}

TEST(Output, TellsThatTheExitStatusIsLost) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);  // then the kernel keeps no exit status
  const Output output = output_of({"/bin/true"}, milliseconds(20000));
  std::signal(SIGCHLD, before);
  EXPECT_EQ(output.trouble, "the exit status is unknown: No child processes");
}

TEST(Output, KeepsTheEndOfEndlessOutput) {
  const Output said = output_of({"/bin/sh", "-c", "head -c 3000000 /dev/zero | tr '\\0' x; echo; echo last"},
                                milliseconds(20000));
  EXPECT_EQ(said.trouble, "");
  EXPECT_EQ(said.out.size(), Output::kMostKept);
  EXPECT_TRUE(said.out.ends_with("\nlast\n"));
}

TEST(Output, ComesFromACleanEnvironment) {
  setenv("LD_LIBRARY_PATH_OF_SOMEBODY", "x", 1);
  setenv("LC_ALL", "de_DE.UTF-8", 1);
  const Output said = output_of({"/usr/bin/env"}, milliseconds(20000));
  EXPECT_THAT(said.out, HasSubstr("LC_ALL=C\n"));
  EXPECT_THAT(said.out, HasSubstr("PATH="));
  EXPECT_EQ(said.out.find("SOMEBODY"), std::string::npos);
  unsetenv("LC_ALL");
}

}  // namespace
}  // namespace adit::host
