#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "loop/file_descriptor.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

class SimulatedButtonTest : public testing::Test {
 protected:
  SimulatedButtonTest() {
    std::string name = (std::filesystem::temp_directory_path() / "adit-button-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    fifo_ = folder_ / "panel.button";
  }
  ~SimulatedButtonTest() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& text) const {
    const loop::FileDescriptor file(::open(fifo_.c_str(), O_WRONLY | O_NONBLOCK));
    ASSERT_EQ(::write(file.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  static bool is_readable(const ButtonLine& button) {
    pollfd poll{.fd = button.descriptor(), .events = POLLIN, .revents = 0};
    return ::poll(&poll, 1, 0) == 1;
  }

  std::filesystem::path folder_, fifo_;
};

TEST_F(SimulatedButtonTest, IsPressedAndReleasedByTextLines) {
  const auto button = simulated_button(fifo_);
  ASSERT_TRUE(button.has_value()) << button.error();
  EXPECT_FALSE((*button)->is_pressed().value());
  EXPECT_FALSE(is_readable(**button));
  write("press\n");
  EXPECT_TRUE(is_readable(**button));
  EXPECT_TRUE((*button)->is_pressed().value());
  EXPECT_FALSE(is_readable(**button)) << "not readable after the writer closed";
  EXPECT_TRUE((*button)->is_pressed().value());
  write("rel");
  EXPECT_TRUE((*button)->is_pressed().value());
  write("ease\n");
  EXPECT_FALSE((*button)->is_pressed().value());
}

TEST_F(SimulatedButtonTest, IgnoresOtherText) {
  const auto button = simulated_button(fifo_);
  for (const std::string& text :
       {std::string("PRESS\n"), std::string(" press\n"), std::string("press \n"), std::string("\n\n"),
        std::string("press\0\n", 7), std::string(30'000, 'x') + "press\n", std::string(5000, '\n')}) {
    write(text);
    EXPECT_FALSE((*button)->is_pressed().value()) << text.substr(0, 20);
  }
  write("unpress\npress\n");
  EXPECT_TRUE((*button)->is_pressed().value());
}

TEST_F(SimulatedButtonTest, IsPrivateAndRemovedAtTheEnd) {
  {
    const auto button = simulated_button(fifo_);
    struct stat status{};
    ASSERT_EQ(stat(fifo_.c_str(), &status), 0);
    EXPECT_TRUE(S_ISFIFO(status.st_mode));
    EXPECT_EQ(status.st_mode & 0777u, 0600u);
  }
  EXPECT_FALSE(std::filesystem::exists(fifo_));
}

TEST_F(SimulatedButtonTest, ReplacesTheFileOfAnEarlierOne) {
  std::ofstream(fifo_) << "press\n";
  const auto button = simulated_button(fifo_);
  ASSERT_TRUE(button.has_value()) << button.error();
  EXPECT_FALSE((*button)->is_pressed().value());
  std::filesystem::create_symlink("/dev/zero", folder_ / "link");
  EXPECT_FALSE(simulated_button(folder_ / "link").value()->is_pressed().value());
}

TEST_F(SimulatedButtonTest, TellsWhyItCannotBeCreated) {
  EXPECT_EQ(simulated_button(folder_ / "later/panel.button").error(),
            "panel: " + (folder_ / "later/panel.button").string() + ": No such file or directory");
}

}  // namespace
}  // namespace adit::panel
