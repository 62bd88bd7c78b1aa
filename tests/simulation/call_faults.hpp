#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Calls of libc that fail on the box's files for a time: in the state folder, or on the journal, the spool
/// and the rejected messages in the runtime folder. One of four runs has up to three of them.
class CallFaults {
 public:
  enum class Call : std::uint8_t {
    Open,    // of any file or directory: no descriptor is left
    List,    // opendir, fdopendir, readdir
    Read,    // read, pread: at once, or behind some bytes
    Less,    // read, pread: some of the bytes, and no error
    Map,     // mmap
    Status,  // stat, fstat, fstatat, lstat
    Write,   // write, pwrite: at once, or behind some bytes
    End
  };

  explicit CallFaults(World& world);
  /// Draws when they come. Each may be left out, by its name. Half of them come with a start of the process.
  void plan(double trouble_for);
  /// When the process is to end, so that a start follows that meets a fault: seconds.
  const std::vector<double>& ends() const { return ends_; }
  /// A process is about to begin.
  void life_begins();

  /// The errno with which this call fails; 0: it does not.
  int error(Call call, const std::string& name);
  /// Of `size` bytes so many are read or written before the call fails; nothing: it does not fail.
  std::optional<std::size_t> cut(Call call, const std::string& name, std::size_t size);
  /// Of all faults of the runtime folder, the end of their names.
  static constexpr const char* kInRuntime = " in runtime";
  const std::string& names() const { return names_; }

 private:
  struct Fault {
    Call call;
    bool in_memory;        // in the runtime folder
    bool at_start;         // it begins with the first start after `begins`
    int number;            // the errno
    double begins, lasts;  // seconds
    double odds;           // that a call fails
    std::uint64_t most;    // calls that fail
    Random random;
    std::string name = {};
    bool is_on = false, was_on = false;
  };
  Fault* hit(Call call, const std::string& name);
  void begin(Fault& fault);
  void end(Fault& fault);

  World& world_;
  Random random_;
  double trouble_for_ = 0;
  std::vector<Fault> faults_;
  std::vector<double> ends_;
  std::string names_;
};

}  // namespace adit::simulation
