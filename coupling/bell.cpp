// SPDX-License-Identifier: Apache-2.0
#include "coupling/bell.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace bw::coupling {
namespace {

/// A name in Linux's abstract space, which leaves no file behind: PROTOCOL.md, "The bell".
std::string name_of(const std::string& job, const std::string& role) {
  return fmt::format("breakwave-{}-{}-{}", getuid(), job, role);
}

std::pair<sockaddr_un, socklen_t> address_of(const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const size_t length = std::min(name.size(), sizeof address.sun_path - 1);
  std::memcpy(address.sun_path + 1, name.data(), length);
  return {address, socklen_t(offsetof(sockaddr_un, sun_path) + 1 + length)};
}

std::string of_rank(const std::string& leader, int rank) {
  return rank == 0 ? leader : fmt::format("{}-{}", leader, rank);
}

void ring_at(int descriptor, const std::string& name) {
  if (descriptor < 0) return;
  const auto [address, length] = address_of(name);
  (void)!sendto(descriptor, "", 1, MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address), length);
}

}  // namespace

Bell::Bell(const std::string& mine, const std::string& other, int rank) {
  const char* job = std::getenv("PMIX_NAMESPACE");
  if (!job) return;
  mine_ = name_of(job, mine);
  const auto [address, length] = address_of(of_rank(mine_, rank));
  descriptor_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor_ < 0) return;
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), length) == 0) {
    other_ = name_of(job, other);
  } else {
    close(descriptor_);
    descriptor_ = -1;
  }
}

Bell::~Bell() {
  if (descriptor_ >= 0) close(descriptor_);
}

void Bell::ring() const { ring_at(descriptor_, other_); }
void Bell::ring(int rank) const { ring_at(descriptor_, of_rank(mine_, rank)); }

bool Bell::wait(double limit) {
  pollfd one{descriptor_, POLLIN, 0};  // a negative descriptor is never ready: then this sleeps
  const timespec time{0, std::clamp(long(1e9 * limit), 0l, 999'999'999l)};
  if (ppoll(&one, 1, &time, nullptr) != 1) return false;
  is_known_ = true;
  char bytes[64];
  while (recv(descriptor_, bytes, sizeof bytes, 0) > 0) continue;
  return true;
}

}  // namespace bw::coupling
