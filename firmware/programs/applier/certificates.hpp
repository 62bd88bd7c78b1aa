#pragma once

#include <expected>
#include <string>

#include "access/certificate.hpp"
#include "applier/options.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"

namespace adit::applier {

/// The work of adit-certificate, on aditd's requests: makes the page's certificate and checks an uploaded
/// one, both by OpenSSL, and writes the status. It runs as aditd's user.
class Certificates {
 public:
  /// In the directory of the status: the certificate in use has changed since the last status.
  static constexpr const char* kRestartFile = "restart";

  /// `options` must outlive this object.
  explicit Certificates(const CertificateOptions& options)
      : options_(options), file_(options.status + '/' + host::kStatusFile) {}

  /// Answers all requests, then returns. Error: the status cannot be written, or a request cannot be removed.
  std::expected<void, std::string> work();

 private:
  std::expected<void, std::string> answer(const access::CertificateRequest& request,
                                          host::UntrustedFolder& folder);
  std::expected<void, std::string> make(const std::string& address) const;
  std::expected<void, std::string> replace(const std::string& text) const;
  /// Whether OpenSSL and so the TLS server can use them. Error: a sentence without a part of the key.
  std::expected<void, std::string> check(const access::KeyAndChain& pem) const;
  std::expected<std::string, std::string> ask_openssl(std::vector<std::string> words) const;
  std::expected<void, std::string> keep(const std::string& text) const;
  std::expected<void, std::string> write_status();
  std::string certificate() const { return options_.state + '/' + access::kCertificateFile; }

  const CertificateOptions& options_;
  host::StatusFile file_;
  access::CertificateStatus status_;
};

}  // namespace adit::applier
