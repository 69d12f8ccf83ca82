// SPDX-License-Identifier: Apache-2.0
// Two dummies that play solid and fluid: a cube in a box of gas, and one accident per scenario.
//   mpirun -n 1 coupled_dummy solid <scenario> : -n 1 coupled_dummy fluid <scenario>
// A scenario is "role:accident" (that role has the accident in window 3), or "none".
#pragma once
#include <string>

#include "coupling/join.h"
#include "coupling/loads.h"

namespace bw::dummy {

struct Scenario {
  std::string accident;  // empty: none, for this role
  bool is(const char* name) const { return accident == name; }
};

constexpr int64_t accident_window = 3, crack_window = 5;
constexpr double t_end = 1e-3, p_ref = 1e5;

/// What a test must see to measure how long the end takes.
void mark_accident();
/// Accidents that can happen anywhere: throw, exit, kill, terminate, hang, return. True: the program shall return from
/// its run.
bool have_accident(const Scenario& scenario);

/// Pressure that the dummy fluid puts on a face: depends on place, identity and window, so that a wrong order is seen.
double pressure(const coupling::WetSurface& surface, size_t face, int64_t window);

int run_solid(const Comm& mine, coupling::Channel& channel, const coupling::CouplingCase& cs, const Scenario& scenario);
int run_fluid(const Comm& mine, coupling::Channel& channel, const coupling::CouplingCase& cs, const Scenario& scenario);

}  // namespace bw::dummy
