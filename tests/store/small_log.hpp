#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "store/log.hpp"

namespace adit::store {

/// Frames of 512 bytes, in two copies; a file holds seven.
inline constexpr LogOptions kSmall{{512, 2}, 8192, true};

/// A log in its own directory.
class SmallLog {
 public:
  explicit SmallLog(const LogOptions& keeps = kSmall) : keeping(keeps) {
    std::string name =
        (std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path().native()) +
        "/adit-store-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no directory");
    path_ = name;
  }
  ~SmallLog() { std::filesystem::remove_all(path_); }
  SmallLog(const SmallLog&) = delete;
  SmallLog& operator=(const SmallLog&) = delete;

  struct Opened {
    Opened(const std::string& path, const LogOptions& keeping)
        : directory(Directory::lock(path).value()),
          contents(Contents::read(directory, keeping).value()),
          log(directory, keeping) {
      log.start(contents).value();
    }
    Directory directory;
    Contents contents;
    Log log;
  };
  /// Opens the log as a process does.
  Opened open() const { return {path_, keeping}; }
  Result<Contents> read() const { return Contents::read(Directory::open(path_).value(), keeping); }

  /// Appends the records in one process.
  void fill(const std::vector<std::string>& bodies, Durability durability) const {
    auto opened = open();
    for (const std::string& body : bodies) opened.log.append(1, body, durability).value();
  }
  /// Writes a snapshot that replaces all earlier records, in one process.
  void snapshot(const std::vector<std::string>& bodies) const {
    auto opened = open();
    opened.log.turn().value();
    auto snapshot = Snapshot::begin(opened.directory, keeping, opened.log).value();
    for (const std::string& body : bodies) snapshot.add(1, body).value();
    snapshot.finish().value();
  }

  const std::string& path() const { return path_; }
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      std::ifstream file(entry.path(), std::ios::binary);
      files[entry.path().filename()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return files;
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ + '/' + name, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  const LogOptions keeping;

 private:
  std::string path_;
};

inline std::vector<std::string> bodies(const Contents& contents) {
  std::vector<std::string> bodies;
  for (const Item& item : contents.items) {
    if (const auto* record = std::get_if<Record>(&item)) bodies.emplace_back(record->body);
  }
  return bodies;
}
inline bool has_gap(const Contents& contents) {
  for (const Item& item : contents.items) {
    if (std::holds_alternative<Gap>(item)) return true;
  }
  return false;
}

}  // namespace adit::store
