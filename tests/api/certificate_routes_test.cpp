#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "access/certificate.hpp"
#include "api/on_page.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using Status = icd::Status;

class CertificateRoutes : public OnPage {
 protected:
  intake::Answer upload(const std::string& pem) {
    return request("POST", "/adit/certificate", {kByToken, {"Content-Type", "application/octet-stream"}},
                   pem);
  }
  /// A browser's request without TLS.
  intake::Answer from_browser(const std::string& method, const std::string& target,
                              const std::string& host = "10.0.0.1:8000") {
    return request(method, target, {{"Host", host}, {"Content-Type", "application/json"}}, "{}");
  }
};

TEST_F(CertificateRoutes, ShowTheFingerprint) {
  const json shown = json::parse(get("/adit/certificate").body);
  EXPECT_EQ(shown, (json{{"offered", true},
                         {"why", ""},
                         {"fingerprint", certificate.view.fingerprint},
                         {"until", "2036-11-28"}}));
}

TEST_F(CertificateRoutes, AcceptNoKeyThatOthersCouldRead) {
  EXPECT_EQ(upload("PEM").status, Status::Conflict);
  peer = local;
  EXPECT_EQ(upload("PEM").status, Status::Ok) << "adit on the box itself";
}

TEST_F(CertificateRoutes, PassAnUploadOn) {
  by_tls = true;
  EXPECT_EQ(upload("PEM").status, Status::Ok);
  EXPECT_EQ(post("/adit/certificate/new").status, Status::Ok);
  EXPECT_THAT(certificate.asked, ElementsAre("take PEM", "make"));
  certificate.outcome = icd::unprocessable("certificate has expired");
  const auto refused = upload("old");
  EXPECT_EQ(refused.status, Status::UnprocessableEntity);
  EXPECT_THAT(refused.body, HasSubstr("certificate has expired"));
}

TEST_F(CertificateRoutes, RejectALargeOrAForeignBody) {
  EXPECT_EQ(upload(std::string(access::kLargestUpload + 1, 'x')).status, Status::ContentTooLarge);
  EXPECT_EQ(post("/adit/certificate", "PEM").status, Status::UnprocessableEntity);
  EXPECT_TRUE(certificate.asked.empty());
}

TEST_F(CertificateRoutes, SendBrowsersToHttpsIfTheSettingsSaySo) {
  EXPECT_EQ(from_browser("GET", "/").status, Status::Ok);
  setup.now.page.https_only = true;
  for (const auto& [host, target, location] : {std::tuple("10.0.0.1:8000", "/", "https://10.0.0.1/"),
                                               {"adit.local", "/setup", "https://adit.local/setup"},
                                               {"[fd00::1]:8000", "/system", "https://[fd00::1]/system"},
                                               {"10.0.0.1", "/x%0d%0aX:y", "https://10.0.0.1/"}}) {
    const auto answer = from_browser("GET", target, host);
    EXPECT_EQ(static_cast<int>(answer.status), 308) << target;
    EXPECT_EQ(header(answer, "Location"), location);
    EXPECT_EQ(header(answer, "Cache-Control"), "no-store");
  }
  for (const auto& [method, target] :
       {std::pair("POST", "/adit/login"), {"GET", "/adit/run"}, {"GET", "/metrics"}, {"POST", "/"}}) {
    const auto answer = from_browser(method, target);
    EXPECT_EQ(answer.status, Status::Unauthorized) << target;
    EXPECT_THAT(answer.body, HasSubstr("https://10.0.0.1"));
  }
}

TEST_F(CertificateRoutes, SendNobodyToHttpsWhoCannotUseItOrNeedsNone) {
  setup.now.page.https_only = true;
  EXPECT_EQ(get("/metrics").status, Status::Ok) << "a script with a token";
  by_tls = true;
  EXPECT_EQ(from_browser("GET", "/").status, Status::Ok);
  by_tls = false;
  local = "127.0.0.1";
  EXPECT_EQ(from_browser("GET", "/").status, Status::Ok);
  local = "10.0.0.1";
  EXPECT_EQ(from_browser("GET", "/", "evil.example").status, Status::Ok)
      << "the page's files, for no redirect";
  certificate.view.offered = false;
  EXPECT_EQ(from_browser("GET", "/").status, Status::Ok) << "the page stays reachable";
}

}  // namespace
}  // namespace adit::api
