#pragma once

#include <expected>
#include <functional>
#include <string>

#include "applier/options.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"
#include "loop/file_descriptor.hpp"
#include "update/bundle.hpp"
#include "update/messages.hpp"

/// State of adit-update that outlives a boot, in its state directory. A missing file reads as the default. An
/// error says what cannot be read, and why. save() returns true once the data survives a power cut.
namespace adit::applier {

std::expected<update::LastUpdate, std::string> load_last_update(const std::string& folder);
bool save(const std::string& folder, const update::LastUpdate& last_update);

std::expected<update::Proven, std::string> load_proven(const std::string& folder);
bool save(const std::string& folder, const update::Proven& proven);

/// An update's file that other users cannot change during checks and installation.
class BundleFile {
 public:
  /// Takes a file out of a directory in which another user writes. The file has no name afterwards, belongs
  /// to this user and is open for writing in no process. After an error the file is still removed, if
  /// possible.
  static std::expected<BundleFile, std::string> take(host::UntrustedFolder& folder, const std::string& name);
  /// Opens a file on a read-only file system.
  static std::expected<BundleFile, std::string> open(const std::string& path);

  /// Path of the same file for other programs of this user, valid while this object lives.
  std::string path() const;

 private:
  explicit BundleFile(loop::FileDescriptor file) : file_(std::move(file)) {}
  loop::FileDescriptor file_;
};

/// VERSION_ID of os-release(5) without quotation marks; "" if absent.
std::string version_in(const std::string& path);

/// RAUC as a program. It describes a bundle only after its signature was verified. Errors are sentences.
class Rauc {
 public:
  explicit Rauc(std::string command) : command_(std::move(command)) {}

  /// The board and the running slot, without the version. Blocks while RAUC is busy, because it gives no
  /// status then.
  std::expected<update::Running, std::string> status() const;
  std::expected<update::Bundle, std::string> info(const std::string& bundle) const;
  /// Writes the other slot and makes it the next to start. `progress`: per cent. After an error RAUC may
  /// still be at work.
  std::expected<void, std::string> install(const std::string& bundle,
                                           const std::function<void(int)>& progress) const;
  /// Marks the running slot healthy and resets its count of starts.
  std::expected<void, std::string> mark_good() const;
  /// Starts the other slot next, with all tries. Its content must have been good once.
  std::expected<void, std::string> start_other_next() const;
  /// Starts the running slot next.
  std::expected<void, std::string> start_booted_next() const;
  /// Starts the running slot next, and the other one not before it is written again.
  std::expected<void, std::string> leave_other() const;

 private:
  std::string command_;
};

/// The work of adit-update: executes aditd's requests one after the other and reports the status.
class Updater {
 public:
  /// `options` must outlive this object.
  explicit Updater(const UpdateOptions& options)
      : options_(options), rauc_(options.rauc), file_(options.status + '/' + host::kStatusFile) {}

  /// Answers all requests, then returns. Error: its own directories are unusable, or a request cannot be
  /// removed. Requests from before the boot are dropped, because their senders have seen them fail.
  std::expected<void, std::string> work();

 private:
  void find_out();
  void look_at_sticks();
  void answer(const update::Request& request, host::UntrustedFolder& folder);
  /// "", or why it failed.
  std::string install(const std::expected<BundleFile, std::string>& file, bool again);
  std::string give_up_other();
  std::string write(const BundleFile& file, const update::Bundle& bundle);
  std::string restart();
  std::string go_back();
  std::string stay();
  void tell_of(update::LastUpdate last_update);
  bool tell() { return file_.tell(status_).has_value(); }

  const UpdateOptions& options_;
  Rauc rauc_;
  std::string boot_;
  update::Status status_;
  std::string on_stick_;  // path of status_.stick
  host::StatusFile file_;
};

}  // namespace adit::applier
