#pragma once

#include <string>

#include "api/certificate.hpp"

namespace adit::api {

/// A box that accepts each upload with a certificate, and each time shows another fingerprint.
struct PlayedCertificate final : Certificate {
  CertificateView state() const override { return view; }
  void replace(const std::string& pem, Done done) override {
    if (!pem.contains("BEGIN CERTIFICATE"))
      return done(icd::unprocessable("there is no certificate in the file; expected PEM"));
    make(done);
  }
  void make(Done done) override {
    view.fingerprint.front() = view.fingerprint.front() == '9' ? '1' : '9';
    done({});
  }
  void offer() {
    view = {.offered = true,
            .fingerprint =
                "90:D6:2F:24:84:4A:A6:02:B1:F5:7F:D7:6B:42:61:46:A5:4A:FC:EA:EA:2F:D1:F5:6F:80:9C:5C:"
                "AE:FA:8E:42",
            .until = "2036-11-28"};
  }

  CertificateView view{.why = "Adit has no TLS server here: it needs systemd and the package stunnel4"};
};

}  // namespace adit::api
