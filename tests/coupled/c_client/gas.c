// SPDX-License-Identifier: Apache-2.0
/* The acoustic fluid in C: p = p0 + rho c (v . n). */
#include <breakwave_coupling.h>
#include <math.h>
#include <stdlib.h>

int main(void) {
  const double p0 = 101325, impedance = 1.225 * 340.3;
  fsi_options options;
  fsi_defaults(&options);
  options.program = "gas in C";
  fsi_fluid* fluid = fsi_fluid_open(&options);
  fsi_surface s;
  while (fsi_recv_surface(fluid, &s)) {
    fsi_load load = {0};
    double* p = malloc(sizeof(double) * (size_t)s.n_faces);
    double* v = malloc(sizeof(double) * 3 * (size_t)s.n_faces);
    load.t1 = fmin(s.t0 + 1e-5, s.t1_max);
    load.p = p;
    fsi_wall_velocity(fluid, load.t1, NULL, v);
    for (int64_t f = 0; f < s.n_faces; ++f) {
      const double *a = s.area + 3 * f, *u = v + 3 * f;
      p[f] = p0 + impedance * (a[0] * u[0] + a[1] * u[1] + a[2] * u[2]) / sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    }
    fsi_send_load(fluid, &load);
    free(p);
    free(v);
  }
  fsi_close(fluid);
  return 0;
}
