// SPDX-License-Identifier: Apache-2.0
// A bell for the ranks of one job on one host: leaders ring each other, and the ranks of their side. MPI has no waiting
// that leaves the core to others: a program that waits sleeps and looks, and messages lie there until it does. Who
// hears the bell looks at once. It carries nothing, and without it (another host, another program, another system) all
// goes on as before.
#pragma once
#include <string>

namespace bw::coupling {

class Bell {
 public:
  /// Of that rank of that role; 0 is the leader. The job is told by its launcher's environment; without that nothing
  /// rings.
  Bell(const std::string& mine, const std::string& other, int rank);
  ~Bell();
  Bell(const Bell&) = delete;

  /// That of the other leader, if there is one.
  void ring() const;
  /// That of a rank of this side.
  void ring(int rank) const;
  /// Until mine rings, `limit` s at most; true: it has.
  bool wait(double limit);
  /// It has rung before: the other one does.
  bool is_known() const { return is_known_; }

 private:
  int descriptor_ = -1;
  std::string mine_, other_;  // names of the leaders' sockets
  bool is_known_ = false;
};

}  // namespace bw::coupling
