#include "admin/update_upload.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "icd/sentence.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::admin {
namespace {

icd::Refusal cannot(const std::string& why) {
  return {icd::Status::ServiceUnavailable, "cannot write the bundle: " + why};
}

}  // namespace

/// Runs on the loop, except write_now(), which runs once at a time in the writer thread.
class UpdateUpload::Writing : public std::enable_shared_from_this<Writing> {
 public:
  Writing(loop::Writer& writer, Ends ends, loop::FileDescriptor file)
      : writer_(writer), ends_(std::move(ends)), file_(std::move(file)) {}

  bool take(std::span<const std::uint8_t> piece) {
    received_ += piece.size();
    waiting_.insert(waiting_.end(), piece.begin(), piece.end());
    if (waiting_.size() < kTogether) return true;
    held_ = busy_;
    if (!busy_) write_waiting();
    return !held_;
  }

  void finish(std::function<void(icd::Checked<void>)> done) {
    done_ = std::move(done);
    if (!busy_) go_on();
  }

  void drop() {
    ends_.resume = [] {};
    if (!dropped_ && !done_) {
      dropped_ = true;
      unlink(ends_.part.c_str());
      ends_.over();
    }
  }

  std::uint64_t received() const { return received_; }

 private:
  void write_waiting() {
    busy_ = true;
    writer_.submit(
        [self = shared_from_this(), bytes = std::exchange(waiting_, {})] { self->write_now(bytes); },
        [self = shared_from_this()] {
          self->busy_ = false;
          self->go_on();
        },
        [self = shared_from_this()] {
          self->busy_ = false;
          self->error_ = ENOMEM;
          self->go_on();
        });
  }

  void write_now(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty() && error_ == 0) {
      const ssize_t count = ::write(file_.get(), bytes.data(), bytes.size());
      if (count >= 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(count));
      } else if (errno != EINTR) {
        error_ = errno;
      }
    }
    // Spreads the flushes, so that the last one is short.
    if (error_ == 0 && fdatasync(file_.get()) != 0) error_ = errno;
    // Frees the space at once, because the ledger may need it while the rest arrives.
    if (error_ != 0 && ftruncate(file_.get(), 0) != 0) file_ = {};
  }

  void go_on() {
    if (dropped_) return;
    if (done_) {
      if (!waiting_.empty() && error_ == 0) return write_waiting();
      return end();
    }
    if (std::exchange(held_, false)) {
      write_waiting();
      ends_.resume();
    }
  }

  void end() {
    icd::Checked<void> outcome = whole();
    if (!outcome) unlink(ends_.part.c_str());
    dropped_ = true;
    ends_.over();
    std::exchange(done_, {})(std::move(outcome));
  }

  icd::Checked<void> whole() {
    if (error_ != 0) return std::unexpected(cannot(std::strerror(error_)));
    if (received_ != ends_.size)
      return std::unexpected(cannot(icd::sentence("got ", received_, " of ", ends_.size, " bytes")));
    file_ = loop::FileDescriptor();  // adit-update rejects a file that is open for writing
    if (std::rename(ends_.part.c_str(), ends_.whole.c_str()) != 0)
      return std::unexpected(cannot(std::strerror(errno)));
    return ends_.asked();
  }

  loop::Writer& writer_;
  Ends ends_;
  loop::FileDescriptor file_;
  std::vector<std::uint8_t> waiting_;
  std::uint64_t received_ = 0;
  int error_ = 0;         // set in the writer thread, read while it is idle
  bool busy_ = false;     // the writer thread is writing
  bool held_ = false;     // the sender is paused
  bool dropped_ = false;  // finished or abandoned
  std::function<void(icd::Checked<void>)> done_;
};

icd::Checked<std::unique_ptr<UpdateUpload>> UpdateUpload::begin(loop::Writer& writer, Ends ends) {
  unlink(ends.part.c_str());
  loop::FileDescriptor file(
      ::open(ends.part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (!file) return std::unexpected(cannot(std::strerror(errno)));
  return std::unique_ptr<UpdateUpload>(
      new UpdateUpload(std::make_shared<Writing>(writer, std::move(ends), std::move(file))));
}

UpdateUpload::~UpdateUpload() {
  writing_->drop();
}

bool UpdateUpload::write(std::span<const std::uint8_t> piece) {
  return writing_->take(piece);
}

void UpdateUpload::finish(std::function<void(icd::Checked<void>)> done) {
  writing_->finish(std::move(done));
}

std::uint64_t UpdateUpload::received() const {
  return writing_->received();
}

}  // namespace adit::admin
