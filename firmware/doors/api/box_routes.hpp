#pragma once

#include <memory>
#include <string>

#include "api/answers.hpp"
#include "api/box.hpp"
#include "api/certificate.hpp"
#include "api/keys.hpp"
#include "api/network.hpp"
#include "api/report_routes.hpp"
#include "api/route.hpp"
#include "api/settings_rows.hpp"
#include "api/source.hpp"
#include "api/spare.hpp"
#include "api/updates.hpp"
#include "intake/server.hpp"

namespace adit::api {

struct LogFilter;

/// The box: metrics, log, about and support bundle. Routes: README.md.
class BoxRoutes {
 public:
  /// All must outlive this object, and the work of `box`.
  BoxRoutes(Source& source, const ReportLists& lists, Box& box, Keys& keys, loop::Loop& loop)
      : source_(source), lists_(lists), box_(box), keys_(keys), loop_(loop) {}

  intake::Answer metrics() const;
  icd::Checked<LogPage> log(const intake::RequestHead& head) const;
  icd::Checked<intake::Answer> log_text(const intake::RequestHead& head) const;
  intake::Answer about() const;
  void bundle(const Call& call);

 private:
  void pack(const std::shared_ptr<intake::Responder>& responder, const SharedRedaction& redaction,
            std::string reports);
  std::string about_json() const;
  std::string metrics_text() const;
  std::string log_lines(const LogFilter& filter) const;

  Source& source_;
  const ReportLists& lists_;
  Box& box_;
  Keys& keys_;
  loop::Loop& loop_;
};

/// The box's addresses: README.md.
namespace network_routes {

CheckView check(Network& network, const Call& call);
intake::Answer change(Network& network, const Call& call);
/// Uses the address of the request's connection.
icd::Checked<void> confirm(Network& network, const Call& call);

}  // namespace network_routes

/// The certificate for HTTPS: README.md.
namespace certificate_routes {

void replace_certificate(Certificate& certificate, const Call& call);
void make(Certificate& certificate, const Call& call);

}  // namespace certificate_routes

/// Updates of the box: README.md.
namespace update_routes {

/// Receives a bundle as a stream. `updates` must outlive the result.
std::unique_ptr<intake::BodySink> receive(Updates& updates, const Call& call);

}  // namespace update_routes

/// Spare and standby. Routes: README.md. `spare` must outlive the answers.
namespace spare_routes {

void send_export(Spare& spare, const Call& call);
void export_to_stick(Spare& spare, const Call& call);
std::unique_ptr<intake::BodySink> begin_import(Spare& spare, const Call& call);
void open(Spare& spare, const Call& call);
icd::Checked<void> take_over(Spare& spare, const std::string& body);

}  // namespace spare_routes
}  // namespace adit::api
