#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "access/certificate.hpp"
#include "api/certificate.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"

namespace adit::admin {

/// The page's certificate, which adit-certificate makes and checks (firmware/rules/access/README.md).
class Certificate final : public api::Certificate {
 public:
  /// Time in which adit-certificate must read a request.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// Wait before an unanswered or failed request for the first certificate is repeated.
  static constexpr std::chrono::seconds kAskAgain{60};
  /// Time after a start in which the team's port gets its address. The first certificate names it.
  static constexpr std::chrono::seconds kAddressWithin{30};
  /// Interval at which a request's result is read.
  static constexpr std::chrono::milliseconds kLook{100};
  /// In aditd's runtime directory: the directory of the answers.
  static constexpr const char* kStatusFolder = "certificate";

  /// Functions of the gateway, called on the loop.
  struct Callbacks {
    /// Whether the TLS server can pass connections to aditd.
    std::function<bool()> serves_tls;
    /// The box's address for the team, or "".
    std::function<std::string()> address;
  };

  /// `state_folder`: for requests. `units`: as host::kStartedAtBoot. `loop` must outlive this object.
  Certificate(loop::Loop& loop, const std::string& state_folder, const std::string& runtime_folder,
              Callbacks callbacks, const std::string& units = host::kStartedAtBoot);

  api::CertificateView state() const override;
  void replace(const std::string& pem, Done done) override;
  void make(Done done) override;

  /// Call each second. Requests a certificate if there is none, and has the TLS server use the one on disk.
  void every_second();

 private:
  using Command = access::CertificateRequest::Command;
  /// Why no request can be made now.
  icd::Checked<void> check_free() const;
  void ask(Command what, Done done);
  void poll();
  void finish(const icd::Checked<void>& done);
  std::string uploaded_file() const { return adit_certificate_.requests() + '/' + access::kUploadedFile; }
  void read();

  loop::Loop& loop_;
  host::RootProgram<access::CertificateStatus> adit_certificate_;
  Callbacks callbacks_;
  const loop::Instant address_until_;
  loop::Source timer_;
  std::string fingerprint_;  // of the certificate on disk; "": there is none, or it cannot be read
  Done done_;                // of the request that is not answered, or null
  std::optional<loop::Instant> kept_at_;  // last request of every_second()
};

}  // namespace adit::admin
