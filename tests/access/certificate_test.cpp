#include "access/certificate.hpp"

#include <gmock/gmock.h>

namespace adit::access {
namespace {

using testing::HasSubstr;

/// Of the DER "adit".
constexpr const char* kCertificate = "-----BEGIN CERTIFICATE-----\nYWRp\r\ndA==\n-----END CERTIFICATE-----";
constexpr const char* kKey = "-----BEGIN PRIVATE KEY-----\nc2VjcmV0\n-----END PRIVATE KEY-----";

std::string both() {
  return std::string(kKey) + '\n' + kCertificate;
}
std::string why(const std::string& text) {
  const auto pem = read_pem(text);
  return pem ? "" : pem.error();
}

TEST(Certificate, IsReadWithItsKeyInAnyOrderAndWithTextAround) {
  const auto pem =
      read_pem("Bag Attributes\n" + std::string(kCertificate) + "\nsubject=x\n" + kKey + "\n" + kCertificate);
  ASSERT_TRUE(pem) << pem.error();
  EXPECT_EQ(pem->key, kKey);
  EXPECT_THAT(pem->chain, testing::ElementsAre(kCertificate, kCertificate));
  EXPECT_EQ(pem->text(), both() + '\n' + kCertificate + '\n');
}

TEST(Certificate, HasTheFingerprintThatBrowsersShow) {
  // printf adit | sha256sum
  EXPECT_EQ(
      fingerprint_of(*read_pem(both())),
      "07:D2:51:CB:E4:BA:D9:90:70:A4:7F:41:67:FF:58:6E:B2:89:3D:7F:F4:87:2E:4A:0D:19:38:72:BD:2F:B9:1A");
  EXPECT_EQ(
      fingerprint_of({.key = "", .chain = {"-----BEGIN CERTIFICATE-----\n!\n-----END CERTIFICATE-----"}}),
      "");
  EXPECT_EQ(fingerprint_of({}), "");
}

TEST(Certificate, IsRejectedWithTheFaultAndWithoutTheKey) {
  EXPECT_THAT(why(""), HasSubstr("no certificate"));
  EXPECT_THAT(why("text"), HasSubstr("no certificate"));
  EXPECT_THAT(why(kCertificate), HasSubstr("no private key"));
  EXPECT_THAT(why(kKey), HasSubstr("no certificate"));
  EXPECT_THAT(why(both() + kKey), HasSubstr("got two"));
  EXPECT_THAT(why(both().substr(0, 60)), HasSubstr("end of a block"));
  EXPECT_THAT(why("-----BEGIN ENCRYPTED PRIVATE KEY-----\nc2VjcmV0\n-----END ENCRYPTED PRIVATE KEY-----"),
              HasSubstr("encrypted"));
  EXPECT_THAT(why("-----BEGIN DH PARAMETERS-----\nYWRp\n-----END DH PARAMETERS-----"),
              HasSubstr("DH PARAMETERS"));
  EXPECT_THAT(why("-----BEGIN " + std::string(100, 'x') + "-----"), HasSubstr("no PEM"));
  std::string many = both();
  for (std::size_t i = 0; i < kMostCertificates; ++i) many += kCertificate;
  EXPECT_THAT(why(many), HasSubstr("at most 8"));
}

}  // namespace
}  // namespace adit::access
