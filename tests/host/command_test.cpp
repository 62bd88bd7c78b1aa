#include <gmock/gmock.h>
#include <sys/resource.h>

#include "host/interfaces.hpp"
#include "host/output.hpp"

namespace adit::host {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Command, RunsToItsEnd) {
  EXPECT_TRUE(run_command({"true"}, milliseconds(20000)));
  EXPECT_TRUE(run_command({"/bin/sh", "-c", "sleep 0.1; exit 0"}, milliseconds(20000)));
}

TEST(Command, TellsWhyItFailed) {
  EXPECT_EQ(run_command({"/bin/sh", "-c", "echo no bus >&2; echo more; exit 3"}, milliseconds(20000)).error(),
            "/bin/sh -c echo no bus >&2; echo more; exit 3: no bus (exit status 3)");
  EXPECT_EQ(run_command({"false"}, milliseconds(20000)).error(), "false: exit status 1");
  EXPECT_THAT(run_command({"/bin/sh", "-c", "kill -9 $$"}, milliseconds(20000)).error(),
              HasSubstr("ended by signal 9"));
  EXPECT_THAT(run_command({"/no/such"}, milliseconds(20000)).error(), StartsWith("/no/such: "));
}

TEST(Command, IsKilledIfItHangs) {
  const auto began = std::chrono::steady_clock::now();
  EXPECT_THAT(run_command({"sleep", "30"}, milliseconds(100)).error(), HasSubstr("took longer than 100 ms"));
  EXPECT_LT(std::chrono::steady_clock::now() - began, milliseconds(20000));
}

TEST(Command, WithEndlessOutputIsReadButNotKept) {
  const auto run = run_command({"/bin/sh", "-c", "head -c 1000000 /dev/zero; exit 1"}, milliseconds(20000));
  ASSERT_FALSE(run);
  EXPECT_LT(run.error().size(), 4096u);
}

TEST(OwnAddress, IsTheFirstOfTheInterface) {
  const auto own = own_address("lo");
  ASSERT_TRUE(own.value());
  EXPECT_EQ((*own)->address, 0x7f000001u);
  EXPECT_EQ((*own)->prefix, 8);
  EXPECT_FALSE(own_address("no-such0").value());
  EXPECT_FALSE(own_address("").value());
  EXPECT_FALSE(own_address("longer-than-any-interface").value());
}

TEST(OwnAddress, UnreadableIsAnError) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const auto own = own_address("lo");
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  ASSERT_FALSE(own);
  EXPECT_EQ(own.error(), "cannot read this machine's addresses: Too many open files");
}

}  // namespace
}  // namespace adit::host
