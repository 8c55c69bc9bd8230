#pragma once

#include <string>

namespace evit {

/// Makes sure UDP multicast works on `lo` without ever leaving the host. Where the machine's `lo` has a route
/// to the group of `url` nothing is done; otherwise this process (and all children it starts later) moves
/// into a network namespace of its own, in which `lo` is up and carries multicast. No privileges needed. Call
/// before any thread or socket is made. Returns whether a namespace was made. Throws std::runtime_error with
/// the remedy where the kernel forbids it.
bool EnsureLocalMulticast(const std::string& url);

/// A file that names this process while it lives, so that scripts/spy can join its namespace.
class RunFile {
 public:
  RunFile();
  ~RunFile();
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

 private:
  std::string path_;
};

}  // namespace evit
