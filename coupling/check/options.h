// SPDX-License-Identifier: Apache-2.0
// What fsi-check was asked for.
#pragma once
#include <string>
#include <vector>

#include "common/math/tensor.h"

namespace bw::coupling::check {

struct Options {
  std::string play;      ///< the role that fsi-check takes: "solid" or "fluid"
  std::string scenario;  ///< inside mpirun: the one to play
  std::vector<std::string> only, skip;
  std::vector<std::string> command;  ///< the program under test
  std::string scheme = "fluid_first";
  double p_ref = 101325, p0 = -1;  ///< Pa; p0 < 0: p_ref
  double rho = 1.225, c = 340.3;   ///< kg/m^3, m/s of the gas at rest around the cube
  double speed = 1;                ///< m/s of the cube
  Vec3 flow{};                     ///< m/s of the fluid's own stream, for "co_moving"
  bool has_flow = false;
  Vec3 centre{0.5, 0.5, 0.5};  ///< m, of the cube
  double edge = 0.2;           ///< m
  double push = 1e5;           ///< Pa above p_ref, on the solid
  double window = 0;           ///< s, longest window of the player; 0: by edge and c, or the solid's stable step
  int windows = 10;
  int ranks = 1;       ///< of the program under test
  double limit = 2;    ///< s from an accident to the end of both programs
  std::string port;    ///< port file by which the program under test is met; empty: one mpirun
  std::string record;  ///< inside mpirun: file for what must not depend on ranks

  double ambient() const { return p0 < 0 ? p_ref : p0; }
};

/// Throws InputError on a wrong command line.
Options read_options(int argc, char** argv);
const char* usage();

}  // namespace bw::coupling::check
