// SPDX-License-Identifier: Apache-2.0
#include "cfd/window_steps.h"

#include <algorithm>

namespace bw::cfd {
namespace {

/// The walls of a window as seen by a step inside it.
class PartOfMotion final : public WallMotion {
 public:
  PartOfMotion(const WallMotion& whole, double t0, double t1)
      : whole_(whole), t0_(t0), t1_(t1), t_(t0), x_(whole.x()), v_(whole.velocity(t1 - t0)) {}
  void go_to(double t) { t_ = t; }
  const coupling::WetSurface& surface() const override { return whole_.surface(); }
  std::vector<Vec3> x() const override { return at(t_); }
  std::vector<Vec3> velocity(double) const override { return v_; }
  std::vector<Vec3> x_end(double dt) const override {
    return t1_ - (t_ + dt) < 1e-9 * (t1_ - t0_) ? whole_.x_end(t1_ - t0_) : at(t_ + dt);
  }

 private:
  std::vector<Vec3> at(double t) const {
    std::vector<Vec3> x = x_;
    for (size_t i = 0; t > t0_ && i < x.size(); ++i) x[i] += (t - t0_) * v_[i];
    return x;
  }
  const WallMotion& whole_;
  double t0_, t1_, t_;
  std::vector<Vec3> x_, v_;
};

/// sum += share * part
template <class V>
void add(std::vector<V>& sum, const std::vector<V>& part, double share) {
  sum.resize(part.size());
  for (size_t i = 0; i < part.size(); ++i) sum[i] += share * part[i];
}

}  // namespace

Stepped window_steps(Model& m, Sweep& sweep, Books& books, const WallMotion& walls, const coupling::Window& window,
                     const WantedStep& wanted, const std::function<double(double)>& next_output,
                     const std::function<void()>& after_step) {
  Stepped whole;
  coupling::Loads& loads = whole.loads;
  const auto step_from = [&](double t, const WallMotion& motion) {
    const double next = std::min(window.t1_max, next_output(t)), want = wanted(t, next);
    const bool goes_on = window.fixed && want < window.t1_max - t;  // then the pressure at its end is not asked for
    whole.dt = step(m, sweep, books, want, &motion, window.mean_pressure || goes_on, &loads);
    m.state.t = whole.dt == want && want >= next - t ? next : t + whole.dt;
  };
  if (!window.fixed) {
    step_from(window.t0, walls);
    loads.t1 = m.state.t;
    return whole;
  }
  const double length = window.t1_max - window.t0;
  PartOfMotion motion(walls, window.t0, window.t1_max);
  std::vector<double> p, impedance;
  std::vector<Vec3> traction;
  for (double t = window.t0; t < window.t1_max; t = m.state.t) {
    if (t > window.t0) after_step();
    motion.go_to(t);
    step_from(t, motion);
    const double share = (m.state.t - t) / length;
    add(p, loads.p, share), add(traction, loads.traction, share), add(impedance, loads.impedance, share);
  }
  if (window.mean_pressure) loads.p = p, loads.traction = traction;
  loads.impedance = impedance;
  loads.t1 = window.t1_max, whole.dt = length;
  return whole;
}

}  // namespace bw::cfd
