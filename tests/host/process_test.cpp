#include "host/process.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

namespace adit::host {
namespace {

TEST(Process, ShowsTheCountersOfTheKernel) {
  const Process before = process();
  EXPECT_GT(before.resident_bytes, 1u << 20);
  EXPECT_LT(before.resident_bytes, 1u << 30);
  EXPECT_GE(before.threads, 1);
  EXPECT_GE(before.most_files, before.open_files);
  EXPECT_GT(before.age_seconds, 0);
  EXPECT_LT(before.age_seconds, 120);
  const int fd = open("/dev/null", O_RDONLY | O_CLOEXEC);
  volatile double sum = 0;
  while (process().cpu_seconds < before.cpu_seconds + 0.02) sum = sum + 1;
  EXPECT_GT(process().age_seconds, before.age_seconds);
  EXPECT_EQ(process().open_files, before.open_files + 1);
  close(fd);
}

TEST(Kernel, IsNamed) {
  EXPECT_THAT(kernel(), testing::MatchesRegex("Linux .+ .+"));
}

TEST(Model, HasNoZeroByte) {
  EXPECT_EQ(model().find('\0'), std::string::npos);
}

}  // namespace
}  // namespace adit::host
