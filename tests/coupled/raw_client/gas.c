// SPDX-License-Identifier: Apache-2.0
/* A fluid written from coupling/PROTOCOL.md alone: MPI and C, nothing of this project. Gas that answers each wall with a plane wave,
 * P = p0 + rho c v.n; one rank. */
#include <math.h>
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double p0 = 101325.0, Z = 1.225 * 340.3, step_wanted = 1e-5;
static MPI_Comm inter;

static double f64(const char* block, int offset) {
  double value;
  memcpy(&value, block + offset, 8);
  return value;
}
static int64_t i64(const char* block, int offset) {
  int64_t value;
  memcpy(&value, block + offset, 8);
  return value;
}
static uint32_t u32(const char* block, int offset) {
  uint32_t value;
  memcpy(&value, block + offset, 4);
  return value;
}
static void put(char* block, int offset, const void* value, int bytes) { memcpy(block + offset, value, (size_t)bytes); }
static void put_f64(char* block, int offset, double value) { put(block, offset, &value, 8); }
static void put_i64(char* block, int offset, int64_t value) { put(block, offset, &value, 8); }
static void put_u32(char* block, int offset, uint32_t value) { put(block, offset, &value, 4); }

/* Waiting and failing, 1 to 4: one of two tags; FAIL ends the program. */
static int wait_for(int tag, int other) {
  for (;;) {
    int there;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, 190, inter, &there, &status);
    if (there) {
      char fail[512];
      int32_t code;
      MPI_Recv(fail, 512, MPI_BYTE, status.MPI_SOURCE, 190, inter, MPI_STATUS_IGNORE);
      memcpy(&code, fail, 4);
      fprintf(stderr, "[gas] the solid failed: %.487s\n", fail + 24);
      MPI_Request ack;
      MPI_Isend(NULL, 0, MPI_BYTE, status.MPI_SOURCE, 191, inter, &ack);
      usleep(200000);
      MPI_Abort(MPI_COMM_WORLD, code);
    }
    MPI_Iprobe(0, tag, inter, &there, MPI_STATUS_IGNORE);
    if (there) return tag;
    MPI_Iprobe(0, other, inter, &there, MPI_STATUS_IGNORE);
    if (there) return other;
    usleep(50);
  }
}
static void receive(int tag, void* data, size_t bytes) {
  wait_for(tag, tag);
  MPI_Recv(data, (int)bytes, MPI_BYTE, 0, tag, inter, MPI_STATUS_IGNORE);
}
static void send(int tag, const void* data, size_t bytes) {
  MPI_Request request;
  MPI_Isend(data, (int)bytes, MPI_BYTE, 0, tag, inter, &request);
  for (int sent = 0; !sent; usleep(50)) MPI_Test(&request, &sent, MPI_STATUS_IGNORE);
}

static void join(void) {
  int rank, size, peer = -1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  char me[32] = "BWCOUPL\nfluid", *all = malloc(32 * (size_t)size);
  put_u32(me, 24, 1);
  MPI_Request request;
  MPI_Iallgather(me, 32, MPI_BYTE, all, 32, MPI_BYTE, MPI_COMM_WORLD, &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  for (int r = size - 1; r >= 0; --r)
    if (strcmp(all + 32 * r + 8, "solid") == 0) peer = r;
  if (peer < 0) MPI_Abort(MPI_COMM_WORLD, 73);
  MPI_Comm side;
  MPI_Comm_split(MPI_COMM_WORLD, 1, rank, &side);
  MPI_Intercomm_create(side, 0, MPI_COMM_WORLD, peer, 100, &inter);
  free(all);
}

static void say_hello(void) {
  char hello[296] = "BWCOUPL\n", other[296];
  put_u32(hello, 8, 0x01020304), put_u32(hello, 12, 1), put_u32(hello, 16, 1), put_u32(hello, 20, 296);
  strcpy(hello + 24, "fluid"), strcpy(hello + 40, "gas"), strcpy(hello + 104, "SI");
  put_f64(hello, 136, p0);
  put_i64(hello, 160, 2); /* can impedance */
  for (int d = 0; d < 3; ++d) put_f64(hello, 176 + 8 * d, -1e30), put_f64(hello, 200 + 8 * d, 1e30);
  put_f64(hello, 248, 600);
  send(100, hello, 296);
  receive(100, other, 296);
  if (memcmp(hello, other, 16) != 0 || f64(other, 136) != p0) MPI_Abort(MPI_COMM_WORLD, 66);
}

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  join();
  say_hello();
  char step[192], bye[256] = {0};
  int64_t nodes = 0, *ids = NULL, known = 0, *known_ids = NULL;
  double *x = NULL, *v = NULL, *wall = NULL; /* wall: x_f of known_ids */
  int32_t *quads = NULL, *faces = NULL;
  while (wait_for(110, 180) == 110) {
    receive(110, step, 192);
    const int64_t n = i64(step, 16), m = i64(step, 24);
    const uint32_t flags = u32(step, 56);
    const double t0 = f64(step, 32), t1_max = f64(step, 40), t1 = (flags & 16) || t0 + step_wanted > t1_max ? t1_max : t0 + step_wanted;
    const double dt = t1 - t0;
    x = realloc(x, 24 * (size_t)n), v = realloc(v, 24 * (size_t)n);
    receive(120, x, 24 * (size_t)n), receive(121, v, 24 * (size_t)n);
    if (flags & 1) {
      known = nodes, known_ids = ids, nodes = n;
      ids = malloc(16 * (size_t)n + 8 * (size_t)m);
      quads = realloc(quads, 16 * (size_t)m), faces = realloc(faces, 8 * (size_t)m);
      receive(122, quads, 16 * (size_t)m), receive(123, ids, 16 * (size_t)n + 8 * (size_t)m), receive(124, faces, 8 * (size_t)m);
      double* now = malloc(24 * (size_t)n);
      for (int64_t i = 0; i < n; ++i) { /* a known node's own x_f, else its parent's, else x */
        memcpy(now + 3 * i, x + 3 * i, 24);
        for (int64_t k = 0; k < 2 * known; ++k)
          if (known_ids[k % known] == (k < known ? ids[n + i] : ids[i])) memcpy(now + 3 * i, wall + 3 * (k % known), 24);
      }
      free(wall), free(known_ids);
      wall = now;
    }
    char load[256] = {0};
    double *p = malloc(8 * (size_t)m), *impedance = malloc(8 * (size_t)m), impulse[3] = {0}, moment[3] = {0}, work = 0, swept = 0;
    for (int64_t f = 0; f < m; ++f) {
      const int32_t* q = quads + 4 * f;
      const int corners = q[3] == q[2] ? 3 : 4;
      double a[3], b[3], A[3], speed[3] = {0}, centre[3] = {0};
      for (int d = 0; d < 3; ++d) {
        a[d] = x[3 * q[2] + d] - x[3 * q[0] + d], b[d] = x[3 * q[3] + d] - x[3 * q[1] + d];
        for (int c = 0; c < corners; ++c) {
          const int i = 3 * q[c] + d;
          speed[d] += (v[i] + (flags & 8 ? (x[i] - wall[i]) / dt : 0)) / corners, centre[d] += x[i] / corners;
        }
      }
      for (int d = 0; d < 3; ++d) A[d] = 0.5 * (a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]);
      const double size = sqrt(A[0] * A[0] + A[1] * A[1] + A[2] * A[2]), vA = speed[0] * A[0] + speed[1] * A[1] + speed[2] * A[2];
      p[f] = p0 + (size > 0 ? Z * vA / size : 0), impedance[f] = Z;
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, g = (d + 2) % 3;
        impulse[d] -= p[f] * A[d] * dt, moment[d] -= p[f] * dt * (centre[e] * A[g] - centre[g] * A[e]);
      }
      work -= p[f] * vA * dt, swept += vA * dt;
    }
    for (int64_t i = 0; i < 3 * n; ++i) wall[i] = x[i] + dt * v[i];
    put(load, 0, step, 16), put_i64(load, 16, m), put_f64(load, 24, t1), put_u32(load, 32, 2);
    for (int d = 0; d < 3; ++d) put_f64(load, 40 + 8 * d, impulse[d]), put_f64(load, 64 + 8 * d, moment[d]);
    put_f64(load, 88, work), put_f64(load, 96, swept), put_f64(load, 192, step_wanted);
    send(130, load, 256), send(131, p, 8 * (size_t)m), send(133, impedance, 8 * (size_t)m);
    free(p), free(impedance);
  }
  receive(180, bye, 256);
  memset(bye, 0, 256);
  send(180, bye, 256);
  return MPI_Finalize();
}
