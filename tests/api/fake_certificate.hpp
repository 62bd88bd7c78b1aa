#pragma once

#include <string>
#include <vector>

#include "api/certificate.hpp"

namespace adit::api {

/// Has the state that a test sets, and records requests.
struct FakeCertificate final : Certificate {
  CertificateView state() const override { return view; }
  void replace(const std::string& pem, Done done) override { record("take " + pem, done); }
  void make(Done done) override { record("make", done); }

  void record(const std::string& what, const Done& done) {
    asked.push_back(what);
    done(outcome);
  }

  CertificateView view{
      .offered = true,
      .fingerprint =
          "90:D6:2F:24:84:4A:A6:02:B1:F5:7F:D7:6B:42:61:46:A5:4A:FC:EA:EA:2F:D1:F5:6F:80:9C:5C:AE:FA:"
          "8E:42",
      .until = "2036-11-28"};
  icd::Checked<void> outcome;
  std::vector<std::string> asked;
};

}  // namespace adit::api
