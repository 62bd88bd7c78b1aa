#include "host/output.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

namespace adit::host {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Output, IsWhatAProgramSaidOnEitherSide) {
  const Output said =
      output_of({"/bin/sh", "-c", "echo one; echo two >&2; printf three"}, milliseconds(5000));
  EXPECT_EQ(said.out, "one\nthree");
  EXPECT_EQ(said.err, "two\n");
  EXPECT_EQ(said.trouble, "");
}

TEST(Output, IsToldLineByLineAsItComes) {
  std::vector<std::string> lines;
  std::vector<std::chrono::steady_clock::time_point> at;
  output_of({"/bin/sh", "-c", "echo one; sleep 0.3; printf 'two\\n\\nthr'"}, milliseconds(5000),
            [&](std::string_view line) {
              lines.emplace_back(line);
              at.push_back(std::chrono::steady_clock::now());
            });
  ASSERT_THAT(lines, ElementsAre("one", "two", ""));
  EXPECT_GE(at[1] - at[0], milliseconds(200));
}

TEST(Output, OfAProgramThatFailsSaysHow) {
  EXPECT_EQ(output_of({"/bin/sh", "-c", "exit 3"}, milliseconds(5000)).trouble, "exit status 3");
  EXPECT_EQ(output_of({"/bin/sh", "-c", "kill -9 $$"}, milliseconds(5000)).trouble, "ended by signal 9");
  EXPECT_THAT(output_of({"/no/such"}, milliseconds(5000)).trouble, StartsWith("No such file"));
  const Output slow = output_of({"/bin/sh", "-c", "echo begun; exec sleep 30"}, milliseconds(200));
  EXPECT_EQ(slow.trouble, "took longer than 200 ms");
  EXPECT_EQ(slow.out, "begun\n");
}

TEST(Output, OfAProgramThatTalksWithoutEndKeepsTheLastOfIt) {
  const Output said = output_of({"/bin/sh", "-c", "head -c 3000000 /dev/zero | tr '\\0' x; echo; echo last"},
                                milliseconds(20000));
  EXPECT_EQ(said.trouble, "");
  EXPECT_EQ(said.out.size(), Output::kMostKept);
  EXPECT_TRUE(said.out.ends_with("\nlast\n"));
}

TEST(Output, ComesFromACleanEnvironment) {
  setenv("LD_LIBRARY_PATH_OF_SOMEBODY", "x", 1);
  setenv("LC_ALL", "de_DE.UTF-8", 1);
  const Output said = output_of({"/usr/bin/env"}, milliseconds(5000));
  EXPECT_THAT(said.out, HasSubstr("LC_ALL=C\n"));
  EXPECT_THAT(said.out, HasSubstr("PATH="));
  EXPECT_EQ(said.out.find("SOMEBODY"), std::string::npos);
  unsetenv("LC_ALL");
}

}  // namespace
}  // namespace adit::host
