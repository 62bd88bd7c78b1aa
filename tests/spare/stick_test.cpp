#include "spare/stick.hpp"

#include <gmock/gmock.h>

namespace adit::spare {
namespace {

constexpr const char* kNonce = "0123456789abcdef0123456789abcdef";

TEST(StickMessages, AreReadAsTheyWereWritten) {
  const StickRequest request{.nonce = kNonce, .what = StickRequest::What::Write, .name = "a.adit-spare"};
  const auto read = codec::read_file<StickRequest>(codec::write_file(request));
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->what, StickRequest::What::Write);
  EXPECT_EQ(read->name, "a.adit-spare");
  const StickStatus status{.nonce = kNonce,
                           .refusal = "no",
                           .doing = "writing",
                           .written = "a.adit-spare",
                           .hindrance = "there is no stick in the box",
                           .exports = {"b.adit-spare", "a.adit-spare"}};
  EXPECT_EQ(codec::read_file<StickStatus>(codec::write_file(status)), status);
}

TEST(StickMessages, AskForNothingOutsideOfAStick) {
  for (const char* const name : {"../../etc/passwd", "/etc/shadow", "a/b.adit-spare", ".adit-spare", ""}) {
    const StickRequest request{.nonce = kNonce, .what = StickRequest::What::Take, .name = name};
    EXPECT_FALSE(codec::read_file<StickRequest>(codec::write_file(request))) << name;
  }
  const StickRequest nameless{.nonce = "x", .what = StickRequest::What::Take, .name = "a.adit-spare"};
  EXPECT_FALSE(codec::read_file<StickRequest>(codec::write_file(nameless)));
  EXPECT_FALSE(codec::read_file<StickRequest>(
      R"({"format":1,"nonce":"0123456789abcdef0123456789abcdef","what":"format","name":"a.adit-spare"})"));
}

}  // namespace
}  // namespace adit::spare
