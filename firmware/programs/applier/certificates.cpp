#include "applier/certificates.hpp"

#include <array>
#include <filesystem>
#include <utility>

#include "host/files.hpp"
#include "host/log.hpp"
#include "host/output.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::applier {
namespace {

using access::CertificateRequest;
using access::KeyAndChain;
using host::Level;

constexpr std::chrono::seconds kWithin{30};
constexpr const char* kDays = "3650";

/// Files for OpenSSL, for this user alone and in memory, while this object exists.
class Scratch {
 public:
  explicit Scratch(std::string folder) : folder_(std::move(folder)) {}
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    for (const std::string& each : written_)
      host::log_failure(Level::Error, "cannot remove a file", host::remove_file(each));
  }
  std::expected<std::string, std::string> write(const std::string& name, const std::string& text) {
    written_.push_back(folder_ + '/' + name);
    ADIT_TRY(host::write_file(written_.back(), text, host::kOursAlone));
    return written_.back();
  }

 private:
  std::string folder_;
  std::vector<std::string> written_;
};

/// OpenSSL's reason in the output of `verify`: "error 10 at 0 depth lookup: certificate has expired".
std::string reason_in(std::string_view output) {
  const std::size_t at = output.find("lookup: ");
  if (at == std::string_view::npos) return "OpenSSL cannot read it";
  output.remove_prefix(at + std::string_view("lookup: ").size());
  return std::string(icd::trim(icd::cut(output, '\n')));
}

/// "2036-11-28" in "notAfter=2036-11-28 14:15:52Z".
std::string day_in(std::string_view output) {
  icd::cut(output, '=');
  return std::string(output.substr(0, 10));
}

}  // namespace

std::expected<void, std::string> Certificates::work() {
  std::error_code error;
  std::filesystem::create_directories(options_.status, error);
  if (error) return std::unexpected(options_.status + ": " + error.message());
  const auto before = file_.read_earlier<access::CertificateStatus>();
  status_ = before.value_or(access::CertificateStatus{});
  ADIT_TRY(host::answer_requests<CertificateRequest>(
      {options_.state, access::kCertificateRequestFile, access::kUploadedFile}, !before,
      [this](const CertificateRequest& request, host::UntrustedFolder& folder) {
        const auto done = answer(request, folder);
        status_.nonce = request.nonce;
        status_.refusal = done ? "" : done.error();
        host::log_failure(Level::Warning, "certificate rejected", done);
        host::log_failure(Level::Error, "cannot write the status", write_status());
      }));
  return write_status();
}

std::expected<void, std::string> Certificates::answer(const CertificateRequest& request,
                                                      host::UntrustedFolder& folder) {
  using enum CertificateRequest::Command;
  if (request.what == Take) {
    auto uploaded = folder.take_file(access::kUploadedFile);
    if (!uploaded) return std::unexpected(std::move(uploaded.error().why));
    if (!*uploaded) return std::unexpected("the uploaded file is gone: try again");
    return replace(**uploaded);
  }
  if (request.what == Make) return make(request.address);
  const auto kept = ADIT_TRY(host::read_optional_file(certificate()));
  if (!kept) return make(request.address);
  const auto pem = access::read_pem(*kept);
  if (pem && !access::fingerprint_of(*pem).empty()) return {};
  host::set_damaged_aside(certificate(), "the certificate", pem ? "it is no base64" : pem.error());
  return make(request.address);
}

std::expected<void, std::string> Certificates::make(const std::string& address) const {
  Scratch scratch(options_.status);
  const auto names = ADIT_TRY(scratch.write(
      "request.conf", icd::sentence("[req]\ndistinguished_name=name\nx509_extensions=page\n[name]\n[page]\n"
                                    "basicConstraints=critical,CA:FALSE\nextendedKeyUsage=serverAuth\n"
                                    "subjectAltName=DNS:adit.local",
                                    address.empty() ? "" : ",IP:", address, "\n")));
  const auto made = ADIT_TRY(
      ask_openssl({"req", "-x509", "-config", names, "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256",
                   "-noenc", "-keyout", "-", "-days", kDays, "-subj", "/CN=adit.local"}));
  const auto pem = ADIT_TRY(access::read_pem(made));
  ADIT_TRY(keep(pem.text()));
  host::log(Level::Notice, "certificate made", {{"fingerprint", access::fingerprint_of(pem)}});
  return {};
}

std::expected<void, std::string> Certificates::replace(const std::string& text) const {
  const auto pem = ADIT_TRY(access::read_pem(text));
  ADIT_TRY(check(pem));
  ADIT_TRY(keep(pem.text()));
  host::log(Level::Notice, "certificate uploaded", {{"fingerprint", access::fingerprint_of(pem)}});
  return {};
}

std::expected<void, std::string> Certificates::check(const KeyAndChain& pem) const {
  Scratch scratch(options_.status);
  const auto key = ADIT_TRY(scratch.write("key.pem", pem.key));
  std::vector<std::string> chain;
  for (const std::string& each : pem.chain) {
    const auto file = ADIT_TRY(scratch.write(icd::sentence("certificate-", chain.size() + 1, ".pem"), each));
    chain.push_back(file);
  }
  const auto public_key = ask_openssl({"pkey", "-in", key, "-pubout", "-passin", "pass:"});
  if (!public_key) return std::unexpected("OpenSSL cannot read the private key");
  const auto certified = ask_openssl({"x509", "-in", chain.front(), "-noout", "-pubkey"});
  if (!certified) return std::unexpected("OpenSSL cannot read the first certificate");
  if (*public_key != *certified)
    return std::unexpected(
        "the private key does not fit the first certificate, which must be the page's own");
  // As strong as the TLS server asks for.
  const auto verify = [this](const std::string& trusted, const std::string& file,
                             std::vector<std::string> more) {
    more.insert(more.begin(), {"verify", "-partial_chain", "-auth_level", "2", "-trusted", trusted});
    more.push_back(file);
    return ask_openssl(std::move(more));
  };
  if (const auto own = verify(chain.front(), chain.front(), {"-purpose", "sslserver"}); !own)
    return std::unexpected("the page's certificate: " + reason_in(own.error()));
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (const auto signed_by = verify(chain[i], chain[i - 1], {}); !signed_by)
      return std::unexpected(icd::sentence("certificate ", i + 1, " of the file did not sign certificate ", i,
                                           ": ", reason_in(signed_by.error())));
  }
  return {};
}

/// The error is the program's output.
std::expected<std::string, std::string> Certificates::ask_openssl(std::vector<std::string> words) const {
  words.insert(words.begin(), options_.openssl);
  auto output = host::output_of(words, kWithin);
  if (output.trouble.empty()) return std::move(output.out);
  return std::unexpected(icd::sentence(options_.openssl, " ", output.trouble, ": ", output.err));
}

std::expected<void, std::string> Certificates::keep(const std::string& text) const {
  return host::write_file(certificate(), text, host::kOursAlone);
}

std::expected<void, std::string> Certificates::write_status() {
  const std::string before = std::exchange(status_.fingerprint, "");
  const auto kept = host::read_optional_file(certificate());
  if (!kept && status_.refusal.empty()) status_.refusal = kept.error();
  const auto pem = kept && *kept ? access::read_pem(**kept) : std::unexpected("");
  if (pem) status_.fingerprint = access::fingerprint_of(*pem);
  if (status_.fingerprint != before) {
    status_.until.clear();
    const auto until =
        ask_openssl({"x509", "-in", certificate(), "-noout", "-enddate", "-dateopt", "iso_8601"});
    if (pem && until) status_.until = day_in(*until);
    ADIT_TRY(host::write_file(options_.status + '/' + kRestartFile, "", host::kOursAlone));
  }
  (void)ADIT_TRY(file_.write(status_));
  return {};
}

}  // namespace adit::applier
