#include <gmock/gmock.h>

#include "cli/run_adit.hpp"
#include "host/folder.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

constexpr const char* kOffered = R"({"offered":true,"why":"","fingerprint":"AB:CD","until":"2036-11-28"})";
constexpr const char* kPem =
    "-----BEGIN PRIVATE KEY-----\nc2VjcmV0\n-----END PRIVATE KEY-----\n"
    "-----BEGIN CERTIFICATE-----\nYWRpdA==\n-----END CERTIFICATE-----\n";

TEST(CertificateCommand, ShowsTheFingerprint) {
  const Server server({{"GET /adit/certificate", Server::ok(kOffered)}});
  const Outcome outcome = run_adit(server, {"certificate"});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_EQ(outcome.out, "HTTPS is offered\nSHA-256 of the certificate: AB:CD\nIts last day: 2036-11-28\n");
}

TEST(CertificateCommand, TellsWhyThereIsNoHttps) {
  const Server server({{"GET /adit/certificate",
                        Server::ok(R"({"offered":false,"why":"no stunnel4","fingerprint":"","until":""})")}});
  const Outcome outcome = run_adit(server, {"certificate", "show"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.out, "HTTPS is not offered: no stunnel4\n");
}

TEST(CertificateCommand, UploadsAFile) {
  const host::Folder folder;
  const std::string file = folder.put("page.pem", kPem);
  const Server server({{"POST /adit/certificate", Server::ok(kOffered)}});
  const Outcome outcome = run_adit(server, {"certificate", "set", file});
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("AB:CD"));
}

TEST(CertificateCommand, SendsNoFileThatIsNoCertificate) {
  const host::Folder folder;
  const Server server{Server::Answers{}};
  const Outcome wrong = run_adit(server, {"certificate", "set", folder.put("x", "rubbish")});
  EXPECT_THAT(wrong.err, HasSubstr("no certificate in the file"));
  EXPECT_THAT(run_adit(server, {"certificate", "set", folder / "none"}).err, HasSubstr("No such file"));
}

TEST(CertificateCommand, MakesANewOneAfterConfirmation) {
  const Server server({{"POST /adit/certificate/new", Server::ok(kOffered)}});
  EXPECT_EQ(run_adit(server, {"certificate", "new"}).exit, Exit::Attention);
  EXPECT_EQ(run_adit(server, {"certificate", "new", "--yes"}).exit, Exit::Fine);
}

}  // namespace
}  // namespace adit::cli
