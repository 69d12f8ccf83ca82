// SPDX-License-Identifier: Apache-2.0
#include "common/app/machine.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <ctime>

#include "common/parallel/loop.h"

namespace bw {

int allowed_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return machine_cpus();  // more than 1024 cpus
  return CPU_COUNT(&set);
}

int machine_cpus() {
  const long n = sysconf(_SC_NPROCESSORS_ONLN);
  return n > 0 ? int(n) : 1;
}

int use_threads(int wanted) {
  if (wanted > 0) set_thread_count(wanted);
  return thread_count();
}

std::string thread_warning(int threads) {
  const int allowed = allowed_cpus(), all = machine_cpus();
  const char* remedy =
      "start mpirun with --bind-to none (or OMPI_MCA_hwloc_base_binding_policy=none), or ask for fewer threads "
      "(--threads)";
  if (threads > allowed) return fmt::format("{} threads share {} of {} cpus: {}", threads, allowed, all, remedy);
  if (allowed < all && threads == allowed && threads == 1)
    return fmt::format("bound to 1 of {} cpus, so 1 thread runs: {}", all, remedy);
  return "";
}

int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return int64_t(usage.ru_maxrss) * 1024;
}

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace bw
