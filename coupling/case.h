// SPDX-License-Identifier: Apache-2.0
// The table [coupling] of the case file: both programs read it, and the handshake compares what they read.
#pragma once
#include <string>

#include "common/math/units.h"

namespace bw::coupling {

/// How a window of time is shared; the numbers travel in HELLO.
enum class Scheme : int { none = 0, fluid_first = 1, box1 = 2, concurrent = 3 };

struct CouplingCase {
  std::string scheme = "fluid_first";  ///< empty: no opinion (a fluid that follows either)
  double reference_pressure = 101325;  ///< Pa; absolute pressure that the solid feels as none
  double window = 0;                   ///< s; 0: the fluid's time step leads
  double window_max = 0;               ///< s; 0: the fluid's time step alone decides
  double added_mass = 0.2;             ///< longest window in (areal mass) / (fluid's impedance) of a face
  std::string radiation = "auto";      ///< faces feel rho c (v - announced v) inside a window
  double silence_limit = 600;          ///< s
  double join_limit = 120;             ///< s
  std::string join = "names";          ///< or "port"
  std::string port_file;
  std::string record, replay;  ///< files; empty: none
  std::string replay_place;    ///< of that key, for errors; empty: from the command line

  template <class K>
  void describe(K& k) {
    k.choice("scheme", scheme, {"fluid_first", "box1", "concurrent"},
             "fluid_first: the wall moves with a predicted velocity, repays its gap, and loads are the window's mean "
             "(2nd order); "
             "box1: the wall moves with the last velocity, loads are the window's end (1st order); "
             "concurrent: as fluid_first, but both programs compute the window at the same time, the solid under loads "
             "that it expects, and what they lacked is given in the next window");
    k.optional("reference_pressure", reference_pressure, dim::pressure,
               "absolute pressure subtracted from the fluid's before it loads the solid");
    k.optional(
        "window", window, dim::time,
        "the solid leads: a fixed time between two exchanges, in which the fluid takes as many steps as it needs; "
        "0 = the fluid leads, a window is one step of it. Not with concurrent");
    k.optional("window_max", window_max, dim::time,
               "longest time between two exchanges; 0 = the fluid's time step alone decides");
    k.optional("added_mass", added_mass, dim::none,
               "longest window as a multiple of (mass per area)/(rho c of the fluid) of the lightest wet face: frozen "
               "loads are unstable "
               "beyond 0.5, half of it for chips wet on both sides; 0 = no limit");
    k.choice(
        "radiation", radiation, {"auto", "always", "never"},
        "inside a window a wet face feels rho c times the difference between its velocity and the announced one, as "
        "sound leaves a wall at once: without it, vibrations of a light solid as fast as the windows grow. auto: but "
        "under "
        "box1, as the others give the impulse back in the next window; never: loads are constant over the window");
    k.optional(
        "silence_limit", silence_limit, dim::time,
        "a program that hears nothing from the other for so long ends both; longer than the fluid needs for a window");
    k.optional("join_limit", join_limit, dim::time, "longest wait for the other program at the start");
    k.choice(
        "join", join, {"names", "port"},
        "names: both programs are in one mpirun and find each other by their roles; port: each has an mpirun of its "
        "own and its MPI_COMM_WORLD for itself, and they meet by port_file, in any order");
    k.optional("port_file", port_file,
               "file in which csd says where it waits, with join = \"port\"; the same for both programs");
    k.expect(join == "names" || !port_file.empty(), "join", "port_file beside join = \"port\"");
    k.optional("record", record,
               "HDF5 file in which csd keeps what crosses between the programs, window by window; or --record FILE");
    k.optional("replay", replay,
               "such a file in place of the other program: csd gets its loads, cfd its surfaces; or --replay FILE");
    if (!replay.empty()) replay_place = k.where("replay");
    k.expect(reference_pressure >= 0, "reference_pressure", "a pressure >= 0");
    k.expect(window >= 0, "window", "a time >= 0");
    k.expect(window == 0 || scheme != "concurrent", "window",
             "none under concurrent: waves that come in are known a window late, and in long windows they grow");
    k.expect(window_max >= 0, "window_max", "a time >= 0");
    k.expect(added_mass >= 0, "added_mass", "a number >= 0");
    k.expect(silence_limit > 0, "silence_limit", "a time > 0");
    k.expect(join_limit > 0, "join_limit", "a time > 0");
  }
  bool radiates() const { return radiation == "always" || (radiation == "auto" && kind() != Scheme::box1); }
  Scheme kind() const {
    if (scheme.empty()) return Scheme::none;
    if (scheme == "concurrent") return Scheme::concurrent;
    return scheme == "box1" ? Scheme::box1 : Scheme::fluid_first;
  }
};

}  // namespace bw::coupling
