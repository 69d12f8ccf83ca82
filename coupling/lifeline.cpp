// SPDX-License-Identifier: Apache-2.0
#include "coupling/lifeline.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "coupling/polite.h"

namespace bw::coupling {
namespace {

bool is_ready(int descriptor, short what, double limit) {
  pollfd one{descriptor, what, 0};
  return poll(&one, 1, int(1e3 * limit)) == 1;
}

/// A host that vanishes from the network is noticed within a minute.
void keep_alive(int descriptor) {
  const int on = 1, idle = 20, interval = 10, tries = 4;
  setsockopt(descriptor, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
  setsockopt(descriptor, IPPROTO_TCP, TCP_KEEPIDLE, &idle, sizeof idle);
  setsockopt(descriptor, IPPROTO_TCP, TCP_KEEPINTVL, &interval, sizeof interval);
  setsockopt(descriptor, IPPROTO_TCP, TCP_KEEPCNT, &tries, sizeof tries);
}

}  // namespace

Lifeline::~Lifeline() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool Lifeline::is_cut() const {
  char byte;
  const ssize_t n = recv(descriptor_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return n == 0 || (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

bool Lifeline::send(const void* data, size_t bytes) const {
  return ::send(descriptor_, data, bytes, MSG_NOSIGNAL) == ssize_t(bytes);
}

bool Lifeline::receive(void* data, size_t bytes, double limit) const {
  const Patience patience;
  for (size_t had = 0; had < bytes;) {
    if (!is_ready(descriptor_, POLLIN, limit - patience.seconds())) return false;
    const ssize_t n = recv(descriptor_, static_cast<char*>(data) + had, bytes - had, 0);
    if (n <= 0) return false;
    had += size_t(n);
  }
  return true;
}

Listener::Listener() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t length = sizeof address;
  descriptor_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (descriptor_ < 0 || bind(descriptor_, any, length) != 0 || listen(descriptor_, 4) != 0 ||
      getsockname(descriptor_, any, &length) != 0)
    throw std::runtime_error(fmt::format("no TCP port to listen at: {}", std::strerror(errno)));
  port_ = ntohs(address.sin_port);
}

Listener::~Listener() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::optional<Lifeline> Listener::accept() const {
  const int descriptor = accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
  if (descriptor < 0) return {};
  keep_alive(descriptor);
  return Lifeline(descriptor);
}

std::string host_name() {
  char name[256] = "localhost";
  gethostname(name, sizeof name - 1);
  return name;
}

std::optional<Lifeline> connect_to(const std::string& host, int port, double limit) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  const std::string where = host == host_name() ? "127.0.0.1" : host;
  if (getaddrinfo(where.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) return {};
  const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  Lifeline line(descriptor);
  const bool begun =
      descriptor >= 0 && (connect(descriptor, found->ai_addr, found->ai_addrlen) == 0 || errno == EINPROGRESS);
  freeaddrinfo(found);
  int error = 0;
  socklen_t length = sizeof error;
  if (!begun || !is_ready(descriptor, POLLOUT, limit) ||
      getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &length) != 0 || error != 0)
    return {};
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  keep_alive(descriptor);
  return line;
}

}  // namespace bw::coupling
