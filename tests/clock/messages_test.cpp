#include "clock/messages.hpp"

#include <gmock/gmock.h>

namespace adit::clock {
namespace {

using testing::HasSubstr;

const Status kStatus{.boot = "b"};

Request request() {
  return {.nonce = "0123456789abcdef0123456789abcdef",
          .source = Source::Operator,
          .time = 1.8e9,
          .at = 100,
          .boot = "b"};
}

TEST(ClockMessages, ReadBackTheSame) {
  const auto read_request = codec::read_file<Request>(codec::write_file(request()));
  ASSERT_TRUE(read_request) << read_request.error();
  EXPECT_EQ(read_request->time, 1.8e9);
  EXPECT_EQ(read_request->source, Source::Operator);
  const Status status{.nonce = "n", .refusal = "why", .source = Source::CommandPost};
  EXPECT_EQ(codec::read_file<Status>(codec::write_file(status)), status);
}

TEST(ClockMessages, InvalidRequestIsRejectedWithTheField) {
  std::string wrong = codec::write_file(request());
  wrong.replace(wrong.find("operator"), 8, "anybodys");
  EXPECT_THAT(codec::read_file<Request>(wrong).error(), HasSubstr("source"));
  EXPECT_FALSE(codec::read_file<Request>("{}"));
  EXPECT_FALSE(codec::read_file<Request>("1.8e9"));
}

TEST(ClockMessages, NtpAcceptsOnlyAddresses) {
  const Ntp both{.server = "10.0.0.5", .clients = "10.0.0.0/24"};
  EXPECT_EQ(codec::read_file<Ntp>(codec::write_file(both)), both);
  EXPECT_EQ(codec::read_file<Ntp>(codec::write_file(Ntp{})), Ntp{});
  for (const char* server : {"ntp.example.org", "10.0.0.5\nallow", "::1", "10.0.0.5 "})
    EXPECT_THAT(codec::read_file<Ntp>(codec::write_file(Ntp{.server = server, .clients = ""})).error(),
                HasSubstr("server"))
        << server;
  for (const char* clients : {"10.0.0.1/24", "10.0.0.0", "10.0.0.0/24\nallow all", "0.0.0.0/33"})
    EXPECT_THAT(codec::read_file<Ntp>(codec::write_file(Ntp{.server = "", .clients = clients})).error(),
                HasSubstr("clients"))
        << clients;
}

TEST(ClockMessages, RequestIsValidForAMinuteOfTheSameBoot) {
  EXPECT_EQ(refusal_reason(request(), 100, kStatus), "");
  EXPECT_EQ(refusal_reason(request(), 160, kStatus), "");
  EXPECT_THAT(refusal_reason(request(), 161, kStatus), HasSubstr("at:"));
  EXPECT_THAT(refusal_reason(request(), 99, kStatus), HasSubstr("at:"));
  EXPECT_THAT(refusal_reason(request(), 100, {.boot = "c"}), HasSubstr("boot:"))
      << "a request of an earlier boot";
}

TEST(ClockMessages, NtpTimeIsValidOnlyFromTheSetServer) {
  Request told = request();
  told.source = Source::Ntp;
  told.server = "10.0.0.5";
  EXPECT_EQ(refusal_reason(told, 100, {.boot = "b", .ntp = {.server = "10.0.0.5"}}), "");
  EXPECT_THAT(refusal_reason(told, 100, {.boot = "b", .ntp = {.server = "10.0.0.6"}}), HasSubstr("server:"));
}

TEST(ClockMessages, FormerNtpServerIsTrustedLikeTheOperator) {
  Status status{.source = Source::Ntp, .server = "10.0.0.5", .ntp = {.server = "10.0.0.5"}};
  EXPECT_EQ(status.trusted_source(), Source::Ntp);
  for (const char* next : {"10.0.0.6", ""}) {
    status.ntp.server = next;
    EXPECT_EQ(status.trusted_source(), Source::Operator) << next;
  }
  status.source = Source::Robots;
  EXPECT_EQ(status.trusted_source(), Source::Robots);
}

TEST(ClockMessages, TimesOutOfBoundsAreRejected) {
  for (const double time : {0.0, kEarliest - 1, kLatest, 1e300}) {
    Request wrong = request();
    wrong.time = time;
    EXPECT_THAT(refusal_reason(wrong, 100, kStatus), HasSubstr("time:")) << time;
  }
  Request chip = request();
  chip.source = Source::Chip;
  EXPECT_THAT(refusal_reason(chip, 100, kStatus), HasSubstr("source:"))
      << "the chip is read by the program itself";
}

}  // namespace
}  // namespace adit::clock
