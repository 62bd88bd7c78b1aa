/// adit-certificate: makes and checks the certificate of the page, for aditd, by OpenSSL, whose parsers are
/// so kept away from the reports.

#include "applier/certificates.hpp"
#include "command_line/read.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<CertificateOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const CertificateOptions& options) {
        return host::log_failure(host::Level::Error, "cannot run", Certificates(options).work()) ? 0 : 1;
      });
}
