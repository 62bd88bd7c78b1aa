#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>

#include "loop/file_descriptor.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

constexpr std::size_t kLongest = 16;  // characters of a line; a longer line is ignored
constexpr int kOursAlone = 0600;

class SimulatedButton final : public ButtonLine {
 public:
  SimulatedButton(loop::FileDescriptor fifo, std::string path)
      : fifo_(std::move(fifo)), path_(std::move(path)) {}
  SimulatedButton(const SimulatedButton&) = delete;
  SimulatedButton& operator=(const SimulatedButton&) = delete;
  ~SimulatedButton() override { unlink(path_.c_str()); }

  int descriptor() const override { return fifo_.get(); }

  /// Reads at most as much as a pipe holds, so that a flood cannot block the loop.
  std::expected<bool, std::string> is_pressed() override {
    std::array<char, 4096> bytes{};
    for (int i = 0; i < 16; ++i) {
      const ssize_t size = read(fifo_.get(), bytes.data(), bytes.size());
      if (size <= 0) break;
      for (const char byte : std::string_view(bytes.data(), static_cast<std::size_t>(size))) handle(byte);
    }
    return pressed_;
  }

 private:
  void handle(char byte) {
    if (byte != '\n') {
      if (line_.size() <= kLongest) line_.push_back(byte);
      return;
    }
    if (line_ == "press") pressed_ = true;
    if (line_ == "release") pressed_ = false;
    line_.clear();
  }

  loop::FileDescriptor fifo_;
  std::string path_, line_;
  bool pressed_ = false;
};

}  // namespace

/// Opened for writing too, because without a writer the FIFO would always be readable.
std::expected<std::unique_ptr<ButtonLine>, std::string> simulated_button(const std::string& fifo) {
  if (unlink(fifo.c_str()) != 0 && errno != ENOENT) return panel_error(fifo, errno);
  if (mkfifo(fifo.c_str(), kOursAlone) != 0) return panel_error(fifo, errno);
  loop::FileDescriptor opened(open(fifo.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW));
  if (opened.get() < 0) return panel_error(fifo, errno);
  return std::make_unique<SimulatedButton>(std::move(opened), fifo);
}

}  // namespace adit::panel
