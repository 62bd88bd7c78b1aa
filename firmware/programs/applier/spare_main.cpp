/// adit-spare: copies exports for a spare box to and from a USB stick, as root, for unprivileged aditd.

#include <expected>
#include <string>

#include "applier/options.hpp"
#include "applier/sticks.hpp"
#include "command_line/read.hpp"
#include "host/log.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "host/untrusted_folder.hpp"
#include "icd/try.hpp"
#include "spare/sealed.hpp"
#include "spare/stick.hpp"

namespace adit::applier {
namespace {

using host::Level;
using Mode = Sticks::Mode;

/// Takes the export to write out of a directory in which another user writes.
std::expected<std::string, std::string> take_export(host::UntrustedFolder& folder) {
  // path_by_descriptor() is a symbolic link, which read_export() does not follow. "/." makes it a directory.
  auto bytes = read_export(folder.path_by_descriptor() + "/.", spare::kForStickFile);
  ADIT_TRY(folder.remove(spare::kForStickFile));
  if (!bytes) return bytes;
  if (std::string why = spare::export_error(*bytes); !why.empty()) return std::unexpected(std::move(why));
  return bytes;
}

/// adit-spare's work: copies exports to and from the stick, one by one, on request, and reports the status.
class SpareKeeper {
 public:
  /// `options` must outlive this object.
  explicit SpareKeeper(const SpareOptions& options)
      : options_(options), sticks_(options), file_(options.status + '/' + host::kStatusFile) {}

  /// Answers all requests, then returns. Error: its own directory is unusable, or a request cannot be
  /// removed. Requests from before the boot are dropped, because their senders have seen them fail.
  std::expected<void, std::string> work() {
    const auto before = file_.read_earlier<spare::StickStatus>();
    status_ = before.value_or(spare::StickStatus{});
    if (!status_.doing.empty()) status_.refusal = "the last action was interrupted: try again";
    status_.doing.clear();
    sticks_.settle();
    refresh();
    if (!write_status()) return std::unexpected("cannot write the status");
    return host::answer_requests<spare::StickRequest>(
        {options_.wanted, spare::kStickRequestFile, spare::kForStickFile}, !before,
        [this](const spare::StickRequest& request, host::UntrustedFolder& folder) {
          answer(request, folder);
        });
  }

 private:
  void answer(const spare::StickRequest& request, host::UntrustedFolder& folder) {
    status_.nonce = request.nonce;
    status_.refusal.clear();
    status_.written.clear();
    status_.refusal = request.what == spare::StickRequest::Command::Write
                          ? write(request.name, take_export(folder))
                          : import_export(request.name);
    status_.doing.clear();
    if (!status_.refusal.empty()) host::log(Level::Warning, "request rejected", {{"why", status_.refusal}});
    refresh();  // the stick may have changed
    write_status();
  }

  /// "", or why it failed.
  std::string write(const std::string& name, const std::expected<std::string, std::string>& bytes) {
    if (!bytes) return bytes.error();
    const auto media = sticks_.media();
    if (!media) return media.error();
    const auto medium = spare::medium_for(*media, bytes->size());
    if (!medium) return medium.error();
    set_action("writing");
    std::string why = write_to(*medium, name, *bytes);
    // Unmounts after an error as well, because the stick may be pulled out.
    const auto done = sticks_.remount(medium->name, Mode::ReadOnly);
    if (!sticks_.is_in(medium->name))
      return "the stick was removed before the export was complete: insert it again";
    if (!why.empty()) return why;
    if (!done) return done.error();
    set_action("checking");
    why = check(*medium, name, *bytes);
    if (why.empty()) {
      status_.written = name;
      host::log(Level::Notice, "export written to a stick", {{"name", name}, {"stick", medium->name}});
    }
    return why;
  }

  std::string write_to(const spare::Medium& medium, const std::string& name, const std::string& bytes) {
    if (const auto writable = sticks_.remount(medium.name, Mode::Writable); !writable)
      return writable.error();
    const auto written = write_export(sticks_.folder(medium.name), name, bytes);
    return written ? "" : written.error();
  }

  /// Compares with the stick's content. The unmount emptied the cache, so the bytes come from the stick.
  std::string check(const spare::Medium& medium, const std::string& name, const std::string& bytes) {
    const auto kept = read_export(sticks_.folder(medium.name), name);
    if (kept && *kept == bytes) return "";
    if (!sticks_.is_in(medium.name))
      return "the stick was removed before the export was checked: export again";
    return "the export on the stick differs from the written bytes: use another stick";
  }

  std::string import_export(const std::string& name) {
    set_action("reading");
    const auto folder = sticks_.folder_with(name);
    if (!folder) return folder.error();
    const auto bytes = read_export(*folder, name);
    if (!bytes) return bytes.error();
    if (std::string why = spare::export_error(*bytes); !why.empty()) return why;
    const auto kept = host::write_file(options_.status + '/' + spare::kFromStickFile, *bytes, host::kForAll);
    return kept ? "" : kept.error();
  }

  void set_action(const char* what) {
    status_.doing = what;
    write_status();
  }

  void refresh() {
    const auto media = sticks_.media();
    if (!media) {
      status_.hindrance = status_.unreadable = media.error();
      status_.exports.clear();
      return;
    }
    const auto medium = spare::medium_for(*media, 0);
    status_.hindrance = medium ? "" : medium.error();
    status_.exports = sticks_.exports(*media, status_.unreadable);
  }

  bool write_status() { return file_.write(status_).has_value(); }

  const SpareOptions& options_;
  Sticks sticks_;
  spare::StickStatus status_;
  host::StatusFile file_;
};

}  // namespace
}  // namespace adit::applier

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<SpareOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const SpareOptions& options) {
        return host::log_failure(host::Level::Error, "cannot run", SpareKeeper(options).work()) ? 0 : 1;
      });
}
