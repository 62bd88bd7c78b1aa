#include "simulation/icd_reading.hpp"

#include <optional>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/command_post/messages.hpp"

namespace adit::simulation {
namespace {

using rehearsal::Findings;

constexpr const char* kToken = "flux230{showroom";

rehearsal::Request read(const HttpMessage& request) {
  const auto header = [&](const char* name) {
    const auto found = request.headers.find(name);
    return found == request.headers.end() ? std::nullopt : std::optional(found->second);
  };
  rehearsal::Request read;
  read.method = request.first.substr(0, request.first.find(' '));
  read.target = read.path = request.path();
  read.authorization = header("authorization");
  read.content_type = header("content-type");
  read.content_encoding = header("content-encoding");
  read.body = request.body;
  return read;
}

void classify_report(const std::string& body, Findings& findings) {
  const auto document = rehearsal::read_document(body, rehearsal::Format::JsonText);
  if (!document) return findings.add_violation("JSON parsing failed: " + document.error());
  if (document->repeated) findings.add_violation("'" + *document->repeated + "' is given twice");
  const rehearsal::Field report(document->value, "", findings);
  rehearsal::read_point(report);
  const auto text = report.text("type");
  if (text && !rehearsal::is_artifact_type(*text)) findings.add_violation("type: none of the ten");
  const auto robot = report.optional_member("name").and_then(&rehearsal::Field::to_text);
  if (robot && !rehearsal::is_robot_name(*robot)) findings.add_violation("name: no robot's");
}

void judge_body(const rehearsal::Request& request, Findings& findings) {
  if (request.method == "GET") return;
  const bool is_report = request.target == rehearsal::kReportsUri;
  rehearsal::check_content(request, !is_report, findings);
  if (is_report) return classify_report(request.body, findings);
  rehearsal::Judgement judgement;
  judgement.uri = request.target;
  const bool cbor = request.content_type == "application/cbor";
  rehearsal::read_mapping(request.body, cbor ? rehearsal::Format::CborBytes : rehearsal::Format::JsonText,
                          judgement);
  for (const rehearsal::Finding& finding : judgement.findings.all()) {
    if (finding.breaks_icd) findings.add_violation(finding.sentence);
  }
}

}  // namespace

std::string fault_of(const HttpMessage& message) {
  const rehearsal::Request request = read(message);
  Findings findings;
  const bool scoring = request.target.starts_with("/api/");
  if (scoring) {
    rehearsal::check_entry(request, rehearsal::kScoringFunctions, kToken, findings);
  } else {
    rehearsal::check_entry(request, rehearsal::kMappingFunctions, kToken, findings);
  }
  if (findings.violations().empty()) judge_body(request, findings);
  const auto violations = findings.violations();
  return violations.empty() ? "" : violations.front();
}

}  // namespace adit::simulation
