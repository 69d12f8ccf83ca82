// SPDX-License-Identifier: Apache-2.0
#include "common/app/guarded.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <sstream>
#include <thread>
#include <utility>

#include "common/app/log.h"

namespace bw {

namespace {

std::function<void(int, const std::string&)>& failure_hook() {
  static std::function<void(int, const std::string&)> hook;
  return hook;
}

int end(const Session& session, int code, const std::string& message) {
  const bool many = session.world().size() > 1;
  if (!message.empty()) {
    show_status("");
    if (many && !speaks()) {
      // all ranks may have met the same error: the speaker has half a second to say it for all; Open MPI then kills the
      // rest as soon as one has died of SIGTERM, and the other program shall come to word before
      std::signal(SIGTERM, SIG_IGN);
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    error_line(message);
  }
  if (code == exit_ok || !many) return code;
  if (auto hook = std::exchange(failure_hook(), nullptr)) {
    try {
      hook(code, message);
    } catch (const std::exception& e) {
      error_line(std::string("while telling the peer: ") + e.what());
    }
  }
  std::fflush(nullptr);
  abort_all(code);
}

}  // namespace

void set_failure_hook(std::function<void(int, const std::string&)> hook) { failure_hook() = std::move(hook); }

bool is_first_of_program(const Session& session) {
  const char* counts = std::getenv("OMPI_APP_CTX_NUM_PROCS");  // "1 2" for -n 1 csd : -n 2 cfd
  if (!counts) return true;
  std::istringstream in(counts);
  const int rank = session.world().rank();
  int first = 0;
  for (int ranks = 0; first < rank && in >> ranks;) first += ranks;
  return first == rank;
}

int guarded(const Session& session, const std::function<int()>& body) {
  try {
    return end(session, body(), "");
  } catch (const InputError& e) {
    return end(session, exit_input, e.what());
  } catch (const PhysicsError& e) {
    return end(session, exit_physics, e.what());
  } catch (const CodedError& e) {
    return end(session, e.code, e.what());
  } catch (const std::bad_alloc&) {
    return end(session, exit_bug, "out of memory");
  } catch (const std::exception& e) {
    return end(session, exit_bug, e.what());
  } catch (...) {
    return end(session, exit_bug, "an unknown exception");
  }
}

}  // namespace bw
