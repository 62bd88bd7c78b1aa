#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace adit::spool {

/// What was read in this process: by read(2) of whatever file, and of files that are mapped from a folder, in
/// the pieces that a look at one byte brings (64 KiB or less).
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
      if (line.find('-') < line.find(' ')) {  // "7f..-7f.. r--s ..", of a file or not
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
