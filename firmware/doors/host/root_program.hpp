#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "codec/row.hpp"
#include "host/service.hpp"
#include "host/untrusted_folder.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/loop.hpp"

/// Requests of aditd, which has no privileges, to a program that runs as root, and its answers. A request is
/// a file in aditd's state directory, which the program removes. The answer is the program's status, a file
/// in its runtime directory that every user can read. The status names the last request by its nonce. Each
/// file is a row (codec/row.hpp).
namespace adit::host {

inline constexpr const char* kStatusFile = "status.json";

/// A unique name of a request: codec::is_nonce().
std::string draw_nonce();

/// A small file's text, or std::nullopt if it does not exist. An error names the file.
std::expected<std::optional<std::string>, std::string> read_optional_file(const std::string& path);
/// The same for a row.
template <class Row>
std::expected<std::optional<Row>, std::string> read_row(const std::string& path) {
  const auto text = ADIT_TRY(read_optional_file(path));
  if (!text) return std::nullopt;
  auto row = codec::read_file<Row>(*text);
  if (!row) return std::unexpected(path + ": " + row.error());
  return *std::move(row);
}

// For aditd.

/// Writes a request into aditd's state directory. Replaces an unread one of that name.
template <class Request>
std::expected<void, std::string> write_request(const std::string& directory, const char* file,
                                               const Request& request) {
  return write_file(directory + '/' + file, codec::write_file(request), kOursAlone);
}
/// Removes a request that was not read in time, and logs it.
void withdraw_request(const std::string& path, const std::string& program);

/// Age at which a status is read again.
inline constexpr std::chrono::milliseconds kFresh{100};
/// Time after the start of aditd in which systemd starts the root programs.
inline constexpr std::chrono::minutes kBoot{5};
/// Links to the units that systemd starts at each boot.
inline constexpr const char* kStartedAtBoot = "/etc/systemd/system/multi-user.target.wants";

/// A root program seen by aditd: its status and the last request. `Status` has `bool names(std::string_view
/// nonce) const`: whether the program has read that request.
template <class Status>
class RootProgram {
 public:
  /// `name`: "adit-clock". `requests`: aditd's state directory. `directory`: the program's runtime directory.
  /// `within`: time in which the program must read a request. `units`: as kStartedAtBoot. `loop` must outlive
  /// this object.
  RootProgram(loop::Loop& loop, std::string name, std::string requests, std::string directory,
              std::chrono::seconds within, const std::string& units = kStartedAtBoot)
      : loop_(loop),
        name_(std::move(name)),
        requests_(std::move(requests)),
        directory_(std::move(directory)),
        within_(within),
        started_until_(can_exist(units + '/' + name_ + ".service") ? loop.now() + kBoot : loop.now()) {}

  const std::string& requests() const { return requests_; }
  const std::string& directory() const { return directory_; }

  /// The status, read at most kFresh ago. Null: see status_error().
  std::shared_ptr<const Status> status() const {
    refresh();
    return status_.value_or(nullptr);
  }
  /// Whether systemd has yet to start the program.
  bool is_starting() const { return !status() && status_ && loop_.now() < started_until_; }
  /// Whether the program has a status file, readable or not, or is starting.
  bool runs_here() const { return status() || !status_ || is_starting(); }
  /// Why there is no status, as a sentence (starting, not running here, unreadable); "": there is a status.
  std::string status_error() const {
    if (status()) return "";
    if (is_starting()) return name_ + " is starting, for at most 5 minutes: try again";
    return status_ ? name_ + " does not run here: it has no status in " + directory_
                   : "cannot read the status of " + name_ + ": " + status_.error();
  }

  /// status_error() as a refusal: 503 while the program is starting, else 409.
  std::unexpected<icd::Refusal> refuse() const {
    return icd::refuse(is_starting() ? icd::Status::ServiceUnavailable : icd::Status::Conflict,
                       status_error());
  }

  /// Writes a request that the status does not name.
  template <class Request>
  std::expected<void, std::string> submit(const char* file, const Request& request) const {
    return write_request(requests_, file, request);
  }
  /// Writes a request with a new nonce and follows it: is_pending(), trouble().
  template <class Request>
  std::expected<void, std::string> ask(const char* file, const Request& request) {
    auto left = submit(file, request);
    if (left) asked_ = PendingRequest{.nonce = request.nonce, .file = file, .at = loop_.now()};
    return left;
  }
  /// Whether the last request is neither named by the status nor withdrawn.
  bool is_pending() const {
    refresh();
    return asked_ && !asked_->is_withdrawn;
  }
  /// Why the last request was withdrawn unread, as a sentence; or "".
  std::string trouble() const {
    refresh();
    if (!asked_ || !asked_->is_withdrawn) return "";
    return name_ + " did not read the request: restart the box; on a PC, see journalctl -u " + name_;
  }
  /// Reads the status. Call each second. True: withdrew the last request, which was not read in time.
  bool check() {
    read();
    if (!is_pending() || loop_.now() < asked_->at + within_) return false;
    asked_->is_withdrawn = true;
    withdraw_request(requests_ + '/' + asked_->file, name_);
    return true;
  }

 private:
  struct PendingRequest {
    std::string nonce;
    const char* file;
    loop::Instant at;
    bool is_withdrawn = false;
  };
  void refresh() const {
    if (!read_at_ || loop_.now() >= *read_at_ + kFresh) read();
  }
  /// A named request is forgotten, because the status of a restarted program does not name it.
  void read() const {
    read_at_ = loop_.now();
    auto read = read_row<Status>(directory_ + '/' + kStatusFile);
    if (!read) {
      status_ = std::unexpected(std::move(read.error()));
    } else {
      status_ = *read ? std::make_shared<const Status>(**std::move(read)) : nullptr;
    }
    if (asked_ && status_ && *status_ && (*status_)->names(asked_->nonce)) asked_.reset();
  }

  loop::Loop& loop_;
  const std::string name_, requests_, directory_;
  const std::chrono::seconds within_;
  const loop::Instant started_until_;
  mutable std::expected<std::shared_ptr<const Status>, std::string> status_;  // null: no file
  mutable std::optional<loop::Instant> read_at_;
  mutable std::optional<PendingRequest> asked_;  // the last request, until the status names it
};

// For the root program.

/// A status that every user can read.
class StatusFile {
 public:
  explicit StatusFile(std::string path) : path_(std::move(path)) {}

  /// The status of an earlier start in this boot, or std::nullopt at the first start. A file that cannot be
  /// read is logged and gives an empty status; the next write() replaces it.
  template <class Status>
  std::optional<Status> read_earlier() const {
    auto status = read_row<Status>(path_);
    if (status) return *std::move(status);
    log_unreadable(status.error());
    return Status{};
  }
  /// Writes a changed status. Returns whether it was written. An error is logged.
  template <class Status>
  std::expected<bool, std::string> write(const Status& status) {
    return write_text(codec::write_file(status));
  }

 private:
  static void log_unreadable(const std::string& why);
  std::expected<bool, std::string> write_text(std::string text);

  std::string path_, told_;
};

/// Opens the directory of aditd's requests. std::nullopt, which is logged, if it does not exist.
std::expected<std::optional<UntrustedFolder>, std::string> open_requests(const std::string& directory);

void log_rejected_request(const char* file, const std::string& why);

/// Takes a request, or std::nullopt if there is none. Malformed ones are logged and skipped. Error: it cannot
/// be removed, so the caller would find it again.
template <class Request>
std::expected<std::optional<Request>, std::string> take_request(UntrustedFolder& folder, const char* file) {
  while (true) {
    const auto text = folder.take_file(file);
    if (text && !*text) return std::nullopt;
    if (!text && text.error().stays) return std::unexpected(text.error().why);
    auto request = text ? codec::read_file<Request>(**text) : std::unexpected(text.error().why);
    if (request) return *std::move(request);
    log_rejected_request(file, request.error());
  }
}

/// The place of one kind of request.
struct RequestPlace {
  std::string directory;
  const char* file;
  const char* beside;  // a file that belongs to the request
};

/// Passes each request to `answer` until there is none. `drop`: first removes a request and its file, because
/// aditd has shown it as failed.
template <class Request>
std::expected<void, std::string> answer_requests(
    const RequestPlace& place, bool drop,
    const std::function<void(const Request&, UntrustedFolder&)>& answer) {
  auto folder = ADIT_TRY(open_requests(place.directory));
  if (!folder) return {};
  for (const char* dropped : {place.file, place.beside}) {
    if (!drop) break;
    if (auto gone = folder->remove(dropped); !gone) return gone;
  }
  while (true) {
    const auto request = ADIT_TRY(take_request<Request>(*folder, place.file));
    if (!request) return {};
    answer(*request, *folder);
  }
}

}  // namespace adit::host
