#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace adit::cli {

class TokenFile {
 public:
  explicit TokenFile(const std::string& token = "sesame-1")
      : path_((std::filesystem::temp_directory_path() / "adit-token-XXXXXX").string()) {
    close(mkstemp(path_.data()));
    std::ofstream(path_) << token << '\n';
  }
  ~TokenFile() { std::filesystem::remove(path_); }
  TokenFile(const TokenFile&) = delete;
  TokenFile& operator=(const TokenFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace adit::cli
