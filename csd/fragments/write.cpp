// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "common/io/file.h"
#include "csd/fragments/fragments.h"

namespace bw::csd {

void write_fragments(const std::string& path, double t, std::span<const Fragment> fragments) {
  std::string text =
      "t [s],id [1],parent [1],birth [s],body [1],elements [1],mass [kg],volume [m^3],"
      "lower_x [m],lower_y [m],lower_z [m],upper_x [m],upper_y [m],upper_z [m],x [m],y [m],z [m],v_x [m/s],v_y "
      "[m/s],v_z [m/s],"
      "L_x [kg m^2/s],L_y [kg m^2/s],L_z [kg m^2/s],spin_x [1/s],spin_y [1/s],spin_z [1/s],kinetic_energy [J],eqps "
      "[1]\n";
  for (const Fragment& f : fragments) {
    text += fmt::format("{:.12g},{},{},{:.12g},{},{},{:.12g},{:.12g}", t, f.id, f.parent, f.birth, f.body, f.elements,
                        f.mass, f.volume);
    for (const Vec3& p : {f.lower, f.upper, f.centroid, f.velocity, f.angular_momentum, f.spin})
      text += fmt::format(",{:.12g},{:.12g},{:.12g}", p.x, p.y, p.z);
    text += fmt::format(",{:.12g},{:.12g}\n", f.kinetic_energy, f.eqps);
  }
  write_atomically(path, text);
}

}  // namespace bw::csd
