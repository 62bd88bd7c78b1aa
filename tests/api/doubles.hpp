#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "api/fake_keys.hpp"
#include "api/fake_network.hpp"
#include "api/no_finer_map.hpp"
#include "api/played.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

struct FakeSource final : Source {
  RunView view() override {
    ++asked;
    return now;
  }
  std::vector<facts::ReportRow> all() const {
    std::vector<facts::ReportRow> rows;
    for (const auto& [number, detail] : details) rows.push_back(detail.row);
    return rows;
  }
  std::vector<facts::ReportRow> reports(std::int64_t after, std::size_t most) const override {
    return rows_after(all(), after, most);
  }
  ReportCounts report_counts() const override { return counts_of(all()); }
  std::optional<ReportDetail> report(std::int64_t number) const override {
    const auto found = details.find(number);
    return found == details.end() ? std::nullopt : std::optional(found->second);
  }

  const picture::Mosaic& map() const override { return mosaic; }
  MarkerChanges markers(std::uint64_t since) const override {
    since_version = since;
    return marker_changes;
  }
  std::vector<Track> tracks(Time since) const override {
    since_time = since;
    return robot_tracks;
  }

  RunView now;
  std::map<std::int64_t, ReportDetail> details;
  picture::Mosaic mosaic;
  MarkerChanges marker_changes;
  std::vector<Track> robot_tracks;
  mutable std::uint64_t since_version = 0;
  mutable Time since_time = 0;
  int asked = 0;
};

/// Returns canned results and records the calls.
struct FakeOperator final : Operator, GatewayControl {
  std::expected<std::int64_t, std::string> decide(std::int64_t number, Action action) override {
    decided.emplace_back(number, action);
    return outcome ? *outcome : number;
  }
  std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report, bool resubmit) override {
    reported.emplace_back(report, resubmit);
    return outcome ? *outcome : 41;
  }
  std::expected<std::int64_t, std::string> correct(std::int64_t number,
                                                   const icd::ArtifactReport& to) override {
    corrected.emplace_back(number, to);
    return outcome ? *outcome : 42;
  }
  std::expected<void, std::string> change_rejected(std::uint64_t number, RejectedAction action) override {
    decided_messages.emplace_back(number, action);
    if (!rejected_trouble.empty()) return std::unexpected(rejected_trouble);
    return {};
  }
  std::expected<void, std::string> acknowledge(const std::string& id) override {
    if (!alarm_trouble.empty()) return std::unexpected(alarm_trouble);
    acknowledged.push_back(id);
    return {};
  }
  std::int64_t begin_run() override { return ++run; }
  icd::Checked<std::string> begin_ledger() override { return ledger; }
  Time identify(double seconds) override {
    identified = seconds;
    return 1000 + seconds;
  }

  std::vector<std::pair<std::int64_t, Action>> decided;
  std::vector<std::pair<icd::ArtifactReport, bool>> reported;
  std::vector<std::pair<std::int64_t, icd::ArtifactReport>> corrected;
  std::optional<std::expected<std::int64_t, std::string>>
      outcome;  // of decide(), report() and correct(), if not the same number, 41 or 42
  std::vector<std::pair<std::uint64_t, RejectedAction>> decided_messages;
  std::string rejected_trouble;  // of change_rejected(); "": it succeeds
  std::vector<std::string> acknowledged;
  std::string alarm_trouble;  // of acknowledge(); "": it succeeds
  std::int64_t run = 1;
  icd::Checked<std::string> ledger = "ledger.damaged-1";
  double identified = 0;  // seconds
};

class FakeHead final : public intake::RequestHead {
 public:
  /// `target`: a path with an optional query.
  FakeHead(std::string method, const std::string& target, std::vector<intake::Header> headers = {},
           std::optional<std::uint64_t> length = 0)
      : method_(std::move(method)), headers_(std::move(headers)), length_(length) {
    std::istringstream rest(target);
    std::getline(rest, path_, '?');
    for (std::string name, value; std::getline(rest, name, '=') && std::getline(rest, value, '&');) {
      query_[name] = value;
    }
    if (header("Host").empty()) headers_.push_back({"Host", "10.0.0.1:8000"});
  }
  std::string_view method() const override { return method_; }
  std::string_view path() const override { return path_; }
  std::string_view query(std::string_view name) const override {
    const auto found = query_.find(name);
    return found == query_.end() ? std::string_view{} : found->second;
  }
  std::string_view header(std::string_view name) const override {
    const auto found = std::ranges::find(headers_, name, &intake::Header::name);
    return found == headers_.end() ? std::string_view{} : found->value;
  }
  std::optional<std::uint64_t> content_length() const override { return length_; }
  const std::string& peer() const override { return peer_; }
  const std::string& local() const override { return local_; }
  bool is_secure() const override { return is_secure_; }
  FakeHead& by_tls() {
    is_secure_ = true;
    return *this;
  }
  FakeHead& from_to(std::string peer, std::string local) {
    peer_ = std::move(peer);
    local_ = std::move(local);
    return *this;
  }

 private:
  std::string method_, path_, peer_, local_;
  std::map<std::string, std::string, std::less<>> query_;
  std::vector<intake::Header> headers_;
  std::optional<std::uint64_t> length_;
  bool is_secure_ = false;
};

struct FakeStream final : intake::Stream {
  bool send(std::string_view bytes) override {
    if (!gone) sent.emplace_back(bytes);
    return !gone;
  }
  bool send_instead(std::string_view bytes) override {
    queued = 0;
    return send(bytes);
  }
  std::size_t waiting() const override { return queued; }
  std::vector<std::string> sent;
  std::size_t queued = 0;
  bool gone = false;
};

struct FakeResponder final : intake::Responder {
  void answer(intake::Answer answer) override { answered = std::move(answer); }
  std::shared_ptr<intake::Stream> stream(std::string_view content_type) override {
    stream_type = content_type;
    return streaming = std::make_shared<FakeStream>();
  }
  bool is_client_gone() const override { return false; }

  std::optional<intake::Answer> answered;
  std::shared_ptr<FakeStream> streaming;
  std::string stream_type;
};

inline const intake::Header kByToken{"Authorization", "Bearer team-1"};

inline std::string header(const intake::Answer& answer, std::string_view name) {
  const auto found = std::ranges::find(answer.headers, name, &intake::Header::name);
  return found == answer.headers.end() ? "" : found->value;
}

/// Forwards requests to a handler that is set later.
struct Forward final : intake::Handler {
  intake::Credentials read_credentials(const intake::RequestHead& head) override {
    return to->read_credentials(head);
  }
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder,
                                         std::shared_ptr<intake::FlowControl> flow) override {
    return to->open(head, std::move(responder), std::move(flow));
  }
  intake::Handler* to = nullptr;
};

}  // namespace adit::api
