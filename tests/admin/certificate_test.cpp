#include "admin/certificate.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "host/folder.hpp"
#include "host/service.hpp"
#include "loop/simulated_time.hpp"

namespace adit::admin {
namespace {

using access::CertificateStatus;
using testing::HasSubstr;
using Command = access::CertificateRequest::Command;
using namespace std::chrono_literals;

constexpr const char* kPem =
    "-----BEGIN PRIVATE KEY-----\nc2VjcmV0\n-----END PRIVATE KEY-----\n"
    "-----BEGIN CERTIFICATE-----\nYWRpdA==\n-----END CERTIFICATE-----\n";

class CertificateTest : public testing::Test {
 protected:
  CertificateTest() { std::filesystem::create_directory(run_ / Certificate::kStatusFolder); }
  void write_status(const CertificateStatus& status) {
    run_.put("certificate/status.json", codec::write_file(status));
    time_.pass(host::kFresh);
  }
  std::optional<access::CertificateRequest> asked() const {
    const auto read = host::read_row<access::CertificateRequest>(state_ / access::kCertificateRequestFile);
    return read ? *read : std::nullopt;
  }
  /// Answers the request as adit-certificate does. `pem`: the certificate in use from now on.
  void answer(const std::string& refusal, const std::string& pem = kPem) {
    const auto request = asked();
    ASSERT_TRUE(request);
    std::filesystem::remove(state_ / access::kCertificateRequestFile);
    state_.put(access::kCertificateFile, pem);
    const auto read = access::read_pem(pem);
    write_status({.nonce = request->nonce,
                  .refusal = refusal,
                  .fingerprint = read ? access::fingerprint_of(*read) : "",
                  .until = "2036-11-28"});
    time_.pass(loop_, Certificate::kLook);
  }
  void expect(const std::string& outcome) {
    ASSERT_TRUE(outcome_) << "no answer";
    EXPECT_THAT(*outcome_, HasSubstr(outcome));
    EXPECT_EQ(outcome_->empty(), outcome.empty()) << *outcome_;
    outcome_.reset();
  }
  Certificate::Done done() {
    return [this](const icd::Checked<void>& done) { outcome_ = done ? "" : done.error().sentence; };
  }
  std::string why() const { return certificate_.state().why; }
  bool has_uploaded() const { return std::filesystem::exists(state_ / access::kUploadedFile); }

  host::Folder state_, run_;
  loop::SimulatedTime time_;
  loop::Loop loop_;
  bool serves_tls_ = true;
  std::string address_ = "10.0.0.1";
  std::optional<std::string> outcome_;
  Certificate certificate_{
      loop_,
      state_.path(),
      run_.path(),
      {.serves_tls = [this] { return serves_tls_; }, .address = [this] { return address_; }},
      "/nowhere"};
};

TEST_F(CertificateTest, IsRequestedIfThereIsNone) {
  write_status({});
  EXPECT_THAT(why(), HasSubstr("being made"));
  certificate_.every_second();
  EXPECT_EQ(asked()->what, Command::Keep);
  EXPECT_EQ(asked()->address, "10.0.0.1");
  answer("");
  const auto view = certificate_.state();
  EXPECT_TRUE(view.offered) << view.why;
  EXPECT_EQ(view.fingerprint, access::fingerprint_of(*access::read_pem(kPem)));
  EXPECT_EQ(view.until, "2036-11-28");
  certificate_.every_second();
  EXPECT_FALSE(asked());
}

TEST_F(CertificateTest, WaitsForTheAddressThatItNames) {
  write_status({});
  address_.clear();
  certificate_.every_second();
  EXPECT_FALSE(asked()) << "networkd has not set it yet";
  address_ = "10.0.0.1";
  certificate_.every_second();
  EXPECT_EQ(asked()->address, "10.0.0.1");
}

TEST_F(CertificateTest, IsMadeWithoutACable) {
  write_status({});
  address_.clear();
  time_.pass(loop_, Certificate::kAddressWithin);
  certificate_.every_second();
  EXPECT_EQ(asked()->address, "");
}

TEST_F(CertificateTest, IsRequestedAgainAfterAWhile) {
  write_status({});
  certificate_.every_second();
  answer("openssl: no such file", "");
  EXPECT_EQ(why(), "openssl: no such file");
  certificate_.every_second();
  EXPECT_FALSE(asked());
  time_.pass(loop_, Certificate::kAskAgain);
  certificate_.every_second();
  EXPECT_TRUE(asked());
}

TEST_F(CertificateTest, OnDiskIsUsedByTheTlsServer) {
  write_status({.fingerprint = "of the one before"});
  state_.put(access::kCertificateFile, kPem);  // by a take-over
  certificate_.every_second();
  EXPECT_EQ(certificate_.state().fingerprint, "");
  EXPECT_EQ(asked()->what, Command::Keep);
}

TEST_F(CertificateTest, NeedsAditCertificateAndTheTlsServer) {
  EXPECT_THAT(why(), HasSubstr("adit-certificate does not run here"));
  certificate_.every_second();
  EXPECT_FALSE(asked());
  certificate_.replace(kPem, done());
  expect("adit-certificate does not run here");
  EXPECT_FALSE(has_uploaded());
  serves_tls_ = false;
  EXPECT_THAT(why(), HasSubstr("stunnel4"));
  EXPECT_FALSE(certificate_.state().offered);
}

TEST_F(CertificateTest, IsReplacedByAnUploadedOne) {
  write_status({});
  certificate_.replace(kPem, done());
  EXPECT_EQ(asked()->what, Command::Take);
  EXPECT_TRUE(has_uploaded());
  EXPECT_FALSE(outcome_);
  certificate_.replace(kPem, [](const icd::Checked<void>& second) {
    EXPECT_THAT(second.error().sentence, HasSubstr("another certificate"));
  });
  answer("");
  expect("");
}

TEST_F(CertificateTest, IsNotReplacedByAWrongOne) {
  write_status({});
  certificate_.replace("rubbish", done());
  answer("there is no certificate in the file");
  expect("no certificate in the file");
  EXPECT_FALSE(has_uploaded());
}

TEST_F(CertificateTest, IsReplacedByANewOne) {
  write_status({});
  certificate_.make(done());
  EXPECT_EQ(asked()->what, Command::Make);
  answer("");
  expect("");
}

TEST_F(CertificateTest, IsNotWaitedForForever) {
  write_status({});
  certificate_.replace(kPem, done());
  time_.pass(loop_, Certificate::kTakenUpWithin + 1s);
  expect("did not read the request");
  EXPECT_FALSE(has_uploaded());
  EXPECT_FALSE(asked());
}

}  // namespace
}  // namespace adit::admin
