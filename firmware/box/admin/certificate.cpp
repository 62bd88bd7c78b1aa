#include "admin/certificate.hpp"

#include <unistd.h>

#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::admin {

Certificate::Certificate(loop::Loop& loop, const std::string& state_folder, const std::string& runtime_folder,
                         Callbacks callbacks, const std::string& units)
    : loop_(loop),
      adit_certificate_(loop, "adit-certificate", state_folder, runtime_folder + '/' + kStatusFolder,
                        kTakenUpWithin, units),
      callbacks_(std::move(callbacks)),
      address_until_(loop.now() + kAddressWithin),
      timer_(loop.timer([this] { poll(); })) {
  read();
}

api::CertificateView Certificate::state() const {
  api::CertificateView view;
  const auto status = adit_certificate_.status();
  if (status && status->fingerprint == fingerprint_) {
    view.fingerprint = status->fingerprint;
    view.until = status->until;
  }
  if (!callbacks_.serves_tls()) {
    view.why = "Adit has no TLS server here: it needs systemd and the package stunnel4";
  } else if (!status) {
    view.why = adit_certificate_.status_error();
  } else if (view.fingerprint.empty()) {
    view.why = status->refusal.empty() ? "the certificate is being made" : status->refusal;
  }
  view.offered = view.why.empty();
  return view;
}

void Certificate::replace(const std::string& pem, Done done) {
  if (auto free = check_free(); !free) return done(std::move(free));
  if (const auto left = host::write_file(uploaded_file(), pem, host::kOursAlone); !left)
    return done(icd::refuse(icd::Status::ServiceUnavailable, left.error()));
  ask(Command::Take, std::move(done));
}

void Certificate::make(Done done) {
  if (auto free = check_free(); !free) return done(std::move(free));
  ask(Command::Make, std::move(done));
}

icd::Checked<void> Certificate::check_free() const {
  if (done_) return icd::conflict("another certificate is being checked: wait");
  if (!adit_certificate_.status()) return adit_certificate_.refuse();
  return {};
}

void Certificate::ask(Command what, Done done) {
  done_ = std::move(done);
  const access::CertificateRequest request{
      .nonce = host::draw_nonce(), .what = what, .address = callbacks_.address()};
  if (const auto left = adit_certificate_.ask(access::kCertificateRequestFile, request); !left)
    return finish(icd::refuse(icd::Status::ServiceUnavailable, left.error()));
  timer_.call_at(loop_.now() + kLook);
}

void Certificate::poll() {
  if (!done_) return;
  if (adit_certificate_.check()) return finish(icd::conflict(adit_certificate_.trouble()));
  const auto status = adit_certificate_.status();
  if (!status || adit_certificate_.is_pending()) return timer_.call_at(loop_.now() + kLook);
  if (status->refusal.empty()) return finish({});
  finish(icd::refuse(icd::Status::UnprocessableEntity, status->refusal));
}

void Certificate::finish(const icd::Checked<void>& done) {
  if (!done) unlink(uploaded_file().c_str());
  read();
  std::exchange(done_, nullptr)(done);
}

void Certificate::every_second() {
  const auto status = adit_certificate_.status();
  if (!status || done_) return;
  if (fingerprint_ != status->fingerprint) read();
  if (!fingerprint_.empty() && fingerprint_ == status->fingerprint) {
    kept_at_.reset();
    return;
  }
  if (kept_at_ && loop_.now() < *kept_at_ + kAskAgain) return;
  if (fingerprint_.empty() && loop_.now() < address_until_ && callbacks_.address().empty()) return;
  kept_at_ = loop_.now();
  ask(Command::Keep, [](const icd::Checked<void>& done) {
    if (!done) host::log(host::Level::Error, "the page has no certificate", {{"why", done.error().sentence}});
  });
}

void Certificate::read() {
  const auto text = host::read_optional_file(adit_certificate_.requests() + '/' + access::kCertificateFile);
  const auto pem = text && *text ? access::read_pem(**text) : std::unexpected("");
  fingerprint_ = pem ? access::fingerprint_of(*pem) : "";
}

}  // namespace adit::admin
