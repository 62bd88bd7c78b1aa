#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Calls of libc that fail on the box's files for some time: in the state directory, or on the journal, the
/// spool and the rejected messages in the runtime directory. One of four runs has up to three such faults,
/// which last up to 15 s, also over a restart.
class CallFaults {
 public:
  enum class Call : std::uint8_t {
    Open,    // EMFILE when any file or directory is opened
    List,    // opendir, fdopendir, readdir
    Read,    // read, pread: at once, or after some bytes
    Less,    // read, pread: fewer bytes than requested, no error
    Map,     // mmap
    Status,  // stat, fstat, fstatat, lstat
    Write,   // write, pwrite: at once, or after some bytes
    End
  };

  explicit CallFaults(World& world);
  /// Draws the times of the faults. Each may be left out by its name. Half of the faults begin with a start
  /// of the process.
  void plan(double trouble_for);
  /// Times in seconds at which the process is to end, so that a start meets a fault.
  const std::vector<double>& ends() const { return ends_; }
  /// Call before each start of the process.
  void process_begins();

  /// The errno with which this call fails, or 0 if it succeeds.
  int error(Call call, const std::string& name);
  /// The number of bytes, of `size`, that are read or written before the call fails; nullopt if it
  /// succeeds.
  std::optional<std::size_t> cut(Call call, const std::string& name, std::size_t size);
  /// Suffix of the names of all faults of the runtime directory.
  static constexpr const char* kInRuntime = " in runtime";
  const std::string& names() const { return names_; }

 private:
  struct Fault {
    Call call;
    bool in_memory;        // in the runtime folder
    bool at_start;         // it begins with the first start after `begins`
    int number;            // the errno
    double begins, lasts;  // seconds
    double odds;           // probability that a call fails
    std::uint64_t most;    // limit of failing calls
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
