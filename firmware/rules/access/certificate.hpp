#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row.hpp"

/// The page's certificate, and the messages, as files, between aditd and adit-certificate: README.md.
namespace adit::access {

/// A private key and its certificates, each as a block of PEM (RFC 7468).
struct KeyAndChain {
  std::string key;
  std::vector<std::string> chain;  // the page's certificate first
  std::string text() const;        // the key first
};
inline constexpr std::size_t kMostCertificates = 8;

/// Ignores text around the blocks. Error, without a part of the key: other blocks, no key or two, no
/// certificate or more than kMostCertificates.
std::expected<KeyAndChain, std::string> read_pem(std::string_view text);

/// SHA-256 of the first certificate in DER, "1A:2B:...", as browsers show it. "": it is no base64.
std::string fingerprint_of(const KeyAndChain& pem);

/// In aditd's state directory, for it alone: KeyAndChain::text().
inline constexpr const char* kCertificateFile = "tls.pem";
/// aditd's request and the uploaded file, in its state directory. adit-certificate removes both.
inline constexpr const char* kCertificateRequestFile = "certificate.json";
inline constexpr const char* kUploadedFile = "certificate.pem";
inline constexpr std::size_t kLargestUpload = 65536;  // bytes

struct CertificateRequest {
  enum class Command : std::uint8_t {
    Keep,  // make one if there is none, or if it is damaged
    Make,  // replace it by a new one
    Take,  // replace it by the uploaded one
  };
  std::string nonce = "";  // codec::is_nonce()
  Command what = Command::Keep;
  std::string address = "";  // of the box, for a new one; or ""
  static const codec::Row kRow;
};

struct CertificateStatus {
  std::string nonce = "";        // of the last request that was read
  std::string refusal = "";      // why that request failed, or ""
  std::string fingerprint = "";  // of the certificate in use; "": none
  std::string until = "";        // its last day: "2036-11-28"; or ""
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const CertificateStatus&, const CertificateStatus&) = default;
};

}  // namespace adit::access
