#include <cerrno>
#include <cstdio>
#include <fstream>
#include <optional>

#include "panel/lines.hpp"

namespace adit::panel {
namespace {

std::string text_of(const Lit& lit) {
  std::string text;
  for (const Light light : kLights) {
    text.append(name_of(light)).append(lit[index_of(light)] ? " on\n" : " off\n");
  }
  return text;
}

class SimulatedLines final : public Lines {
 public:
  explicit SimulatedLines(std::string file) : file_(std::move(file)) {}
  SimulatedLines(const SimulatedLines&) = delete;
  SimulatedLines& operator=(const SimulatedLines&) = delete;
  ~SimulatedLines() override { [[maybe_unused]] const bool dark = write({}); }

  std::expected<void, std::string> set(const Lit& lit) override {
    if (shown_ == lit) return {};
    if (!write(lit)) return panel_error(file_, errno);
    shown_ = lit;
    return {};
  }

 private:
  /// Renames a new file, so that a reader never sees half of it. It need not survive a power cut.
  bool write(const Lit& lit) {
    const std::string temporary = file_ + ".new";
    std::ofstream stream(temporary, std::ios::trunc);
    stream << text_of(lit);
    stream.close();
    return stream.good() && std::rename(temporary.c_str(), file_.c_str()) == 0;
  }

  std::string file_;
  std::optional<Lit> shown_;
};

}  // namespace

std::unique_ptr<Lines> make_simulated_lines(std::string file) {
  return std::make_unique<SimulatedLines>(std::move(file));
}

}  // namespace adit::panel
