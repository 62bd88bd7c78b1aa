#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace adit::spool {

/// Bytes that this process has read: by read(2) from any file, and from mapped files of a directory, in
/// pieces that one access loads (at most 64 KiB).
struct BytesRead {
  std::uint64_t by_calls = 0, in_mappings = 0;

  static BytesRead of(const std::string& folder) {
    BytesRead read;
    std::string word;
    std::ifstream account("/proc/self/io");
    EXPECT_TRUE(account >> word >> read.by_calls && word == "rchar:");
    bool is_there = false;
    std::ifstream mappings("/proc/self/smaps");
    for (std::string line; std::getline(mappings, line);) {
      if (line.find('-') < line.find(' ')) {  // "7f..-7f.. r--s ..", mapped from a file or not
        is_there = line.contains(' ' + folder + '/');
      } else if (is_there && line.starts_with("Rss:")) {
        read.in_mappings += 1024 * std::stoull(line.substr(4));
      }
    }
    EXPECT_TRUE(mappings.eof());
    return read;
  }
};

}  // namespace adit::spool
