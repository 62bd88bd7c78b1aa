#include "applier/certificates.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>

#include "host/folder.hpp"
#include "host/output.hpp"
#include "host/service.hpp"

namespace adit::applier {
namespace {

namespace fs = std::filesystem;
using access::CertificateRequest;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using enum CertificateRequest::Command;

constexpr const char* kPage = "basicConstraints=critical,CA:FALSE\nextendedKeyUsage=serverAuth\n";
constexpr const char* kAuthority = "basicConstraints=critical,CA:TRUE\nkeyUsage=keyCertSign\n";

/// A key with its certificate, from OpenSSL.
struct Pair {
  std::string key, certificate;
};

class CertificatesTest : public testing::Test {
 protected:
  CertificatesTest() {
    options.state = folder / "state";
    options.status = folder / "run";
    fs::create_directories(options.state);
    work();
  }

  void work() {
    const auto done = Certificates(options).work();
    EXPECT_TRUE(done) << done.error();
  }
  void ask(CertificateRequest::Command what, const std::string& address = "") {
    const CertificateRequest request{.nonce = host::draw_nonce(), .what = what, .address = address};
    ASSERT_TRUE(host::write_request(options.state, access::kCertificateRequestFile, request));
    work();
    EXPECT_EQ(status().nonce, request.nonce);
    EXPECT_THAT(*host::names_in(options.status), Not(testing::Contains(testing::EndsWith(".pem"))));
  }
  void upload(const std::string& text) {
    folder.put(std::string("state/") + access::kUploadedFile, text);
    ask(Take);
  }
  access::CertificateStatus status() const {
    return **host::read_row<access::CertificateStatus>(options.status + '/' + host::kStatusFile);
  }
  std::string in_use() const { return *host::read_file(file()); }
  std::string file() const { return options.state + '/' + access::kCertificateFile; }
  bool asks_for_restart() { return fs::remove(options.status + '/' + Certificates::kRestartFile); }

  static std::string openssl(std::vector<std::string> words) {
    words.insert(words.begin(), "openssl");
    auto output = host::output_of(words, std::chrono::seconds(30));
    EXPECT_EQ(output.trouble, "") << output.err;
    return std::move(output.out);
  }
  std::string text_of(const std::string& pem) const {
    return openssl({"x509", "-in", pem, "-noout", "-text"});
  }
  /// `more`: further words, such as the signing certificate's.
  Pair made(const std::string& name, const std::string& extensions, std::vector<std::string> more = {},
            const std::string& algorithm = "ec") {
    const std::string configuration =
        folder.put(name + ".conf",
                   "[req]\ndistinguished_name=name\nx509_extensions=page\n[name]\n[page]\n" + extensions);
    std::vector<std::string> words{"req",
                                   "-x509",
                                   "-config",
                                   configuration,
                                   "-newkey",
                                   algorithm,
                                   "-noenc",
                                   "-keyout",
                                   folder / (name + ".key"),
                                   "-out",
                                   folder / (name + ".pem"),
                                   "-subj",
                                   "/CN=" + name};
    if (algorithm == "ec") words.insert(words.end(), {"-pkeyopt", "ec_paramgen_curve:P-256"});
    words.insert(words.end(), more.begin(), more.end());
    openssl(words);
    return {*host::read_file(folder / (name + ".key")), *host::read_file(folder / (name + ".pem"))};
  }
  std::vector<std::string> signed_by(const std::string& name) const {
    return {"-CA", folder / (name + ".pem"), "-CAkey", folder / (name + ".key")};
  }

  host::Folder folder;
  CertificateOptions options;
};

TEST_F(CertificatesTest, AreMadeForTheAddressIfThereIsNone) {
  EXPECT_EQ(status(), access::CertificateStatus{});
  ask(Keep, "10.0.0.1");
  EXPECT_EQ(status().refusal, "");
  EXPECT_THAT(status().fingerprint, MatchesRegex("([0-9A-F]{2}:){31}[0-9A-F]{2}"));
  EXPECT_THAT(status().until, MatchesRegex("20[0-9]{2}-[0-9]{2}-[0-9]{2}"));
  struct stat found{};
  ASSERT_EQ(stat(file().c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0600U);
  const std::string text = text_of(file());
  EXPECT_THAT(text, HasSubstr("DNS:adit.local, IP Address:10.0.0.1"));
  EXPECT_THAT(text, HasSubstr("NIST CURVE: P-256"));
  EXPECT_THAT(openssl({"x509", "-in", file(), "-noout", "-fingerprint", "-sha256"}),
              HasSubstr(status().fingerprint));
}

TEST_F(CertificatesTest, AreMadeWithoutAnAddress) {
  ask(Keep);
  EXPECT_THAT(text_of(file()), HasSubstr("DNS:adit.local\n"));
}

TEST_F(CertificatesTest, AreKeptOverStartsAndChangesOfTheAddress) {
  ask(Keep, "10.0.0.1");
  const std::string before = in_use();
  work();
  ask(Keep, "10.0.0.9");
  EXPECT_EQ(in_use(), before);
}

TEST_F(CertificatesTest, AreReplacedOnRequest) {
  ask(Keep);
  const std::string before = status().fingerprint;
  ask(Make, "10.0.0.9");
  EXPECT_NE(status().fingerprint, before);
  EXPECT_THAT(text_of(file()), HasSubstr("10.0.0.9"));
}

TEST_F(CertificatesTest, ReplaceADamagedOneAndKeepItAside) {
  ASSERT_TRUE(host::write_file(file(), "torn", host::kOursAlone));
  ask(Keep);
  EXPECT_NE(status().fingerprint, "");
  EXPECT_EQ(*host::read_file(file() + host::kDamaged), "torn");
}

TEST_F(CertificatesTest, RestartTheTlsServerOnlyAfterAChange) {
  EXPECT_FALSE(asks_for_restart());
  ask(Keep);
  EXPECT_TRUE(asks_for_restart());
  ask(Keep);
  upload("rubbish");
  EXPECT_FALSE(asks_for_restart());
  ask(Make);
  EXPECT_TRUE(asks_for_restart());
}

TEST_F(CertificatesTest, TellWhyThereIsNone) {
  options.openssl = "no-such-openssl";
  ask(Keep);
  EXPECT_THAT(status().refusal, HasSubstr("no-such-openssl"));
  EXPECT_EQ(status().fingerprint, "");
}

TEST_F(CertificatesTest, AcceptAnUploadedOneWithItsChainInOrder) {
  made("root", kAuthority);
  const Pair between = made("between", kAuthority, signed_by("root"));
  const Pair page = made("page", kPage, signed_by("between"));
  upload(page.certificate + between.certificate + page.key);
  EXPECT_EQ(status().refusal, "");
  EXPECT_EQ(access::read_pem(in_use())->chain.size(), 2U);
  EXPECT_FALSE(fs::exists(options.state + '/' + access::kUploadedFile));
}

TEST_F(CertificatesTest, RejectAnUploadThatABrowserOrTheServerWouldReject) {
  ask(Keep);
  const std::string before = in_use();
  const Pair root = made("root", kAuthority), other = made("other", kPage);
  const Pair page = made("page", kPage, signed_by("root"));
  const Pair client = made("client", "extendedKeyUsage=clientAuth\n");
  const Pair weak = made("weak", kPage, {}, "rsa:1024");
  const std::string old =
      openssl({"x509", "-in", folder / "other.pem", "-signkey", folder / "other.key", "-days", "-1"});
  const std::string encrypted =
      openssl({"pkey", "-in", folder / "page.key", "-aes128", "-passout", "pass:secret"});
  const std::pair<std::string, const char*> rows[] = {
      {"rubbish", "no certificate"},
      {page.certificate, "no private key"},
      {page.certificate + other.key, "does not fit the first certificate"},
      {root.certificate + page.certificate + page.key, "does not fit the first certificate"},
      {page.certificate + other.certificate + page.key,
       "certificate 2 of the file did not sign certificate 1"},
      {root.certificate + root.key, "unsuitable certificate purpose"},
      {client.certificate + client.key, "unsuitable certificate purpose"},
      {old + other.key, "certificate has expired"},
      {weak.certificate + weak.key, "too weak"},
      {page.certificate + encrypted, "encrypted"},
      {page.certificate + "-----BEGIN PRIVATE KEY-----\nYWRp\n-----END PRIVATE KEY-----\n",
       "cannot read the private key"},
      {"-----BEGIN CERTIFICATE-----\nYWRp\n-----END CERTIFICATE-----\n" + page.key,
       "cannot read the first certificate"},
  };
  for (const auto& [text, why] : rows) {
    upload(text);
    EXPECT_THAT(status().refusal, HasSubstr(why));
    EXPECT_THAT(status().refusal, Not(HasSubstr("\n")));
    EXPECT_EQ(in_use(), before);
  }
}

}  // namespace
}  // namespace adit::applier
