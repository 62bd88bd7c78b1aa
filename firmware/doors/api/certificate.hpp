#pragma once

#include <functional>
#include <string>

#include "codec/row.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// The page over HTTPS, and its certificate.
struct CertificateView {
  bool offered = false;          // HTTPS at port 443
  std::string why = "";          // why not, or ""
  std::string fingerprint = "";  // of the certificate, or ""
  std::string until = "";        // the certificate's last day: "2036-11-28"; or ""
  static const codec::Row kRow;
};

/// A refusal says why not.
class Certificate {
 public:
  using Done = std::function<void(icd::Checked<void>)>;

  virtual ~Certificate() = default;
  virtual CertificateView state() const = 0;
  /// Replaces the certificate by a key and its certificates (PEM), once they are checked. Calls `done` later.
  virtual void replace(const std::string& pem, Done done) = 0;
  /// Replaces the certificate by a new one of the box's own. Calls `done` later.
  virtual void make(Done done) = 0;
};

}  // namespace adit::api
