// SPDX-License-Identifier: Apache-2.0
// What the machine gives this process.
#pragma once
#include <cstdint>
#include <string>

namespace bw {

int allowed_cpus();  ///< that this process may run on (binding, cpu sets)
int machine_cpus();  ///< that are online

/// Sets the number of threads of all parallel loops: `wanted`, or for 0 what OMP_NUM_THREADS or the machine gives.
/// Returns the number set.
int use_threads(int wanted);

/// Empty if all is well; else what is wrong with `threads` on this machine and the remedy.
std::string thread_warning(int threads);

int64_t peak_memory();  ///< bytes, of this process
double cpu_seconds();   ///< of all threads of this process

}  // namespace bw
