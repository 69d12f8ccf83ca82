// SPDX-License-Identifier: Apache-2.0
#include "coupling/expected_loads.h"

#include <algorithm>
#include <cmath>

namespace bw::coupling {
namespace {

/// The gentler of two slopes; none where they disagree: behind a shock that has just come nothing goes on rising.
double gentler(double a, double b) { return a * b > 0 ? (std::abs(a) < std::abs(b) ? a : b) : 0; }

}  // namespace

void ExpectedLoads::begin(const Window& window, const WetSurface& surface) {
  window_ = window;
  path_.begin(window, surface);
}

std::vector<double> ExpectedLoads::speeds(const WetSurface& surface, double t1) const {
  const std::vector<Vec3> v = path_.velocity(t1 - window_.t0);
  std::vector<double> speeds;
  for (const auto& quad : surface.quads) {
    const Vec3 area = area_vector(surface.x, quad);
    const double size = norm(area);
    speeds.push_back(size > 0 ? dot(face_mean(v, quad), area) / size : 0);
  }
  return speeds;
}

Loads ExpectedLoads::expect(const WetSurface& surface, double t1) const {
  const std::vector<double> speed = speeds(surface, t1);
  const double middle = 0.5 * (window_.t0 + t1);
  Loads loads;
  loads.t1 = t1;
  for (size_t f = 0; f < speed.size(); ++f) {
    const auto known = faces_.find(surface.face_id[f]);
    const Face face = known == faces_.end() ? Face{0, p_ref_, 0, 0, middle, 0} : list_[known->second];
    loads.p.push_back(face.incoming + face.slope * (middle - face.middle) + face.impedance * speed[f]);
    loads.impedance.push_back(face.impedance);
  }
  return loads;
}

void ExpectedLoads::answered(const WetSurface& surface, const Loads& loads) {
  const std::vector<double> speed = speeds(surface, loads.t1);
  const double middle = 0.5 * (window_.t0 + loads.t1);
  std::vector<Face> now;
  for (size_t f = 0; f < speed.size(); ++f) {
    const double impedance = loads.impedance.empty() ? 0 : loads.impedance[f];
    Face face{surface.face_id[f], loads.p[f] - impedance * speed[f], 0, 0, middle, impedance};
    if (const auto known = faces_.find(face.id); known != faces_.end()) {
      const Face& before = list_[known->second];
      face.rise = (face.incoming - before.incoming) / (middle - before.middle);
      face.slope = gentler(face.rise, before.rise);
    }
    now.push_back(face);
  }
  list_ = std::move(now);
  index();
  path_.end(loads.t1 - window_.t0);
}

void ExpectedLoads::index() {
  faces_.clear();
  for (size_t i = 0; i < list_.size(); ++i) faces_[list_[i].id] = i;
}

}  // namespace bw::coupling
