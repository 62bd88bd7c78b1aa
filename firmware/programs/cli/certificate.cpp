#include "api/certificate.hpp"

#include <chrono>

#include "access/certificate.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "host/files.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

using api::CertificateView;

constexpr const char* kCertificate = "/adit/certificate";
/// The box checks or makes it before it answers.
constexpr std::chrono::seconds kChecked{70};

std::string text_of(const CertificateView& view, bool /*colour*/) {
  std::string out = view.offered ? line("HTTPS is offered") : line("HTTPS is not offered: ", view.why);
  if (!view.fingerprint.empty()) out += line("SHA-256 of the certificate: ", view.fingerprint);
  if (!view.until.empty()) out += line("Its last day: ", view.until);
  return out;
}

Result<Outcome> replace(const Call& call, const char* target, std::string body, const char* content_type) {
  auto done = ADIT_TRY(post(call.adit, {.target = target,
                                        .check = "adit certificate",
                                        .body = std::move(body),
                                        .within = kChecked,
                                        .content_type = content_type}));
  const auto view = ADIT_TRY(read_row_of<CertificateView>(call.adit, std::move(done)));
  return print_result(call, view.json, text_of(view.row, false));
}

}  // namespace

Result<Outcome> show_certificate(const Call& call) {
  return show<CertificateView>(call, kCertificate, text_of,
                               [](const CertificateView& view) { return view.offered; });
}

Result<Outcome> set_certificate(const Call& call) {
  const std::string& path = call.options.argument();
  auto file = host::slurp(path, access::kLargestUpload);
  if (!file) return to_failure(host::path_error(path, file.error()));
  if (const auto pem = access::read_pem(file->text); !pem) return to_failure(path + ": " + pem.error());
  return replace(call, kCertificate, std::move(file->text), "application/octet-stream");
}

Result<Outcome> make_certificate(const Call& call) {
  ADIT_TRY(confirm(call.options, call.console,
                   "Browsers warn again, and show the new certificate's fingerprint.",
                   "Replace the certificate by a new one?"));
  return replace(call, "/adit/certificate/new", "{}", "application/json");
}

}  // namespace adit::cli
