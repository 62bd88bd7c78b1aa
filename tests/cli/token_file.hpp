#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace adit::cli {

/// A file that holds the token "sesame-1", for the length of a test.
class TokenFile {
 public:
  TokenFile() : path_((std::filesystem::temp_directory_path() / "adit-token-XXXXXX").string()) {
    close(mkstemp(path_.data()));
    std::ofstream(path_) << "sesame-1\n";
  }
  ~TokenFile() { std::filesystem::remove(path_); }
  TokenFile(const TokenFile&) = delete;
  TokenFile& operator=(const TokenFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace adit::cli
