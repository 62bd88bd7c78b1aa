#include "access/certificate.hpp"

#include <sodium.h>

#include <array>

#include "codec/base64.hpp"
#include "codec/nonce.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::access {
namespace {

constexpr std::string_view kBegin = "-----BEGIN ", kEnd = "-----END ", kDashes = "-----";
constexpr std::string_view kCertificate = "CERTIFICATE", kKey = "PRIVATE KEY";

/// The base64 of a block, without its first and last line.
std::string_view pem_body(std::string_view block) {
  const std::size_t first = block.find('\n'), last = block.rfind(kEnd);
  return last == std::string_view::npos || first >= last ? "" : block.substr(first, last - first);
}

std::vector<std::uint8_t> der_of(std::string_view block) {
  std::string digits(pem_body(block));
  std::erase_if(digits, [](char each) { return icd::trim({&each, 1}).empty(); });
  std::vector<std::uint8_t> der(digits.size());
  codec::Base64Decoder decoder;
  std::string_view rest = digits;
  const auto size = decoder.decode(rest, der);
  std::array<std::uint8_t, 2> last{};
  const auto more = size ? decoder.finish(last) : std::unexpected("");
  if (!more || !rest.empty()) return {};
  der.resize(*size);
  der.insert(der.end(), last.begin(), last.begin() + static_cast<std::ptrdiff_t>(*more));
  return der;
}

}  // namespace

static constexpr std::string_view kCommandWords[] = {"keep", "make", "take"};  // in the order of Command
static constexpr auto& words_of(CertificateRequest::Command /*of*/) {
  return kCommandWords;
}

std::string KeyAndChain::text() const {
  std::string text = key + '\n';
  for (const std::string& each : chain) text += each + '\n';
  return text;
}

std::expected<KeyAndChain, std::string> read_pem(std::string_view text) {
  KeyAndChain pem;
  while (true) {
    const std::size_t begin = text.find(kBegin);
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const std::string_view label =
        text.substr(kBegin.size(), text.find(kDashes, kBegin.size()) - kBegin.size());
    if (label.size() > 64 || label.contains('\n')) return std::unexpected("the file is no PEM");
    const std::string end = icd::sentence(kEnd, label, kDashes);
    const std::size_t size = text.find(end);
    if (size == std::string_view::npos)
      return std::unexpected("the end of a block is missing in the PEM file");
    const std::string_view block = text.substr(0, size + end.size());
    text.remove_prefix(block.size());
    if (label == kCertificate) {
      if (pem.chain.size() == kMostCertificates)
        return std::unexpected(icd::sentence("expected at most ", kMostCertificates, " certificates"));
      pem.chain.emplace_back(block);
    } else if (label == "ENCRYPTED PRIVATE KEY" || block.contains("ENCRYPTED")) {
      return std::unexpected("the key is encrypted: remove its passphrase (openssl pkey -in KEY -out PLAIN)");
    } else if (label.ends_with(kKey)) {
      if (!pem.key.empty()) return std::unexpected("expected one private key, got two");
      pem.key = block;
    } else if (label != "EC PARAMETERS") {  // openssl ecparam -genkey writes it before the key
      return std::unexpected(
          icd::sentence("expected a private key and certificates, got ", icd::quote_text(label)));
    }
  }
  if (pem.chain.empty()) return std::unexpected("there is no certificate in the file; expected PEM");
  if (pem.key.empty())
    return std::unexpected("there is no private key in the file: put key and certificates into one file");
  return pem;
}

std::string fingerprint_of(const KeyAndChain& pem) {
  const auto der = pem.chain.empty() ? std::vector<std::uint8_t>() : der_of(pem.chain.front());
  if (der.empty()) return "";
  std::array<std::uint8_t, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256(hash.data(), der.data(), der.size());
  std::string text;
  for (const std::uint8_t each : hash) {
    for (const char digit : icd::hex(each))
      text += digit < 'a' ? digit : static_cast<char>(digit - 'a' + 'A');
    text += ':';
  }
  text.pop_back();
  return text;
}

namespace {

constexpr codec::Member kRequestMembers[] = {
    codec::member<&CertificateRequest::nonce>("nonce").matching(codec::kNonce),
    codec::member<&CertificateRequest::what>("what"),
    codec::member<&CertificateRequest::address>("address"),
};
constexpr codec::Member kStatusMembers[] = {
    codec::member<&CertificateStatus::nonce>("nonce"),
    codec::member<&CertificateStatus::refusal>("refusal"),
    codec::member<&CertificateStatus::fingerprint>("fingerprint"),
    codec::member<&CertificateStatus::until>("until"),
};

}  // namespace

constexpr codec::Row CertificateRequest::kRow = codec::complete<CertificateRequest>({"", kRequestMembers});
constexpr codec::Row CertificateStatus::kRow = codec::complete<CertificateStatus>({"", kStatusMembers});

}  // namespace adit::access
