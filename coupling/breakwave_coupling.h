// SPDX-License-Identifier: Apache-2.0
/* libbreakwave_coupling: the fluid's half of a coupled run for any program that can call C. The wire underneath:
 * PROTOCOL.md.
 *
 *   fsi_options options;
 *   fsi_defaults(&options);
 *   options.program = "my fluid";
 *   fsi_fluid* fluid = fsi_fluid_open(&options);
 *   fsi_surface surface;
 *   while (fsi_recv_surface(fluid, &surface)) {      one window of time a pass
 *     ... choose t1 in (surface.t0, surface.t1_max], move the walls there, find one pressure a face ...
 *     fsi_send_load(fluid, &load);
 *   }
 *   fsi_close(fluid);
 *
 *   mpirun -n 1 csd case.toml : -n 1 my_fluid
 *
 * A program that needs MPI_COMM_WORLD for itself, or comes later, is started apart and names a port_file, the case's
 * coupling.port_file (PROTOCOL.md, Joining by a port).
 *
 * SI units, absolute pressure, arrays in C order; [n][3] is x, y, z of item 0, of item 1, ... A face is a quad of four
 * nodes, counted from 0, whose normal by the right-hand rule points into the fluid; a triangle has its last node twice.
 *
 * With several ranks every function is collective over the fluid's ranks, unless it says otherwise: all ranks get the
 * surface, the load of rank 0 counts.
 *
 * Errors: no function returns one. Whatever goes wrong on either side is printed by both programs and ends both with
 * the same exit code (PROTOCOL.md), within seconds. So do exit() and an uncaught exception between fsi_fluid_open and
 * the end of the run. One fsi_fluid a process; not thread-safe. MPI is started by fsi_fluid_open if it has not been,
 * and then ended by fsi_close. */
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FSI_PROTOCOL_MAJOR 1
#define FSI_PROTOCOL_MINOR 2

/* The library's binary interface: this number rises with any change of a struct or function below, members added at an
 * end included, and is the number in the library's name (libbreakwave_coupling.so.1): a program starts with the
 * interface that it was compiled for or not at all. One that loads the library by hand asks fsi_abi() first. */
#define FSI_ABI 1

/* flags of a face */
#define FSI_FACE_LIP 1  /* made by a crack; its two lips lay on each other when it was born */
#define FSI_FACE_THIN 2 /* part of an open shell: wet on both sides, encloses nothing */

/* schemes; the two programs must name the same one, or one of them none */
#define FSI_SCHEME_NONE 0
#define FSI_SCHEME_FLUID_FIRST 1
#define FSI_SCHEME_BOX1 2
#define FSI_SCHEME_CONCURRENT 3 /* for the fluid the same as FLUID_FIRST */

typedef struct fsi_fluid fsi_fluid;

/* What the fluid says of itself. fsi_defaults first: members may be added. */
typedef struct fsi_options {
  const char* program;  /* name for people, up to 31 bytes, as the next two; "fluid" */
  const char* version;  /* "" */
  const char* units;    /* the program's own, for the log only: the wire is SI; "SI" */
  double p_ref;         /* Pa, the case's coupling.reference_pressure: both programs must state the same; 101325 */
  double t0;            /* s, start of the run; 0 */
  double t_end;         /* s, the run ends at the smaller of the two programs' ends; <= 0: no opinion; 0 */
  double lower[3];      /* m, box of the fluid's domain; a surface wholly outside is an error, partly outside a warning;
                           -1e30 */
  double upper[3];      /* m; 1e30 */
  int scheme;           /* FSI_SCHEME_...; FSI_SCHEME_NONE */
  double silence_limit; /* s without the awaited message before the run is ended; the smaller of the two programs'
                           counts; 600 */
  double join_limit;    /* s to wait for the other program at the start; 120 */
  const char* port_file; /* NULL: csd is in the same mpirun; a path: it was started apart and is met by this file; then
                            MPI_COMM_WORLD is the fluid's alone; NULL */
} fsi_options;

/* The solid's wet surface at t0 and what it wants. Pointers are valid until the next fsi_recv_surface. */
typedef struct fsi_surface {
  int64_t window;           /* 0, 1, 2, ... */
  int64_t topo_version;     /* changes if and only if quads, ids, body or flags change */
  int64_t n_nodes, n_faces; /* n_faces may be 0 */
  double t0, t1_max;        /* s; the window may end at any t1 with t0 < t1 <= t1_max */
  double dt_stable;         /* s, the solid's stable step */
  int new_topology;         /* 1 in the first window and whenever topo_version has changed */
  int last;                 /* 1: the solid ends after this window */
  int mean_pressure;        /* 1: p shall be the window's mean (fluid_first); 0: the pressure at t1 (box1) */
  const double* x;          /* [n_nodes][3] m, the solid at t0 */
  const double* v;          /* [n_nodes][3] m/s, announced for the whole window */
  const double* x_wall; /* [n_nodes][3] m, the fluid's wall at t0 (fluid_first: the prediction of the window before) */
  const int32_t* quads; /* [n_faces][4] indices of nodes */
  const int64_t* node_id;     /* [n_nodes] stable, never used again */
  const int64_t* node_parent; /* [n_nodes] node_id of the node it was split from, -1: none */
  const int64_t* face_id;     /* [n_faces] stable, never used again */
  const int32_t* body;        /* [n_faces] */
  const int32_t* flags;       /* [n_faces] FSI_FACE_... */
  const double* area;         /* [n_faces][3] m^2, area vector at t0, into the fluid */
  const double* centre;       /* [n_faces][3] m, mean of the face's nodes at t0 */
  int fixed; /* 1: the window ends at t1_max, in as many of the fluid's steps as it needs; t1 must be t1_max */
} fsi_surface;

/* The answer. Zero what is unknown: memset, then t1 and p at least. */
typedef struct fsi_load {
  double t1;               /* s, end of the window */
  const double* p;         /* [n_faces] Pa, absolute, in the order of the surface */
  const double* traction;  /* [n_faces][3] Pa, on the solid beyond -p n; NULL: none */
  const double* impedance; /* [n_faces] kg/(m^2 s), rho c at the face: lets the solid keep windows stable on light
                              faces; NULL: unknown */
  int stop;                /* 1: the fluid wants the run to end after this window */
  double mass, energy;     /* kg, J of the whole fluid at t1, for the books */
  double momentum[3];      /* kg m/s */
  double mass_covered, mass_uncovered;     /* kg since the start, lost and made by cells that a wall swept */
  double energy_covered, energy_uncovered; /* J */
  int64_t dry_faces;                       /* faces without fluid, which got p_ref */
  double dry_area;                         /* m^2 */
  double dt_next; /* s, the step that the fluid would take next: under concurrent the next window is so long; 0: unknown,
                     then it is as long as the last window whose end the fluid chose, if there was one */
} fsi_load;

/* Not collective, needs no MPI. */
void fsi_defaults(fsi_options* options);
const char* fsi_version(void); /* of the library, "0.1.0" */
int fsi_abi(void);             /* FSI_ABI of the library */

/* Joins the run and shakes hands. Read and check your input before. Never NULL. */
fsi_fluid* fsi_fluid_open(const fsi_options* options);
/* s, the smaller of the two programs' ends. Not collective. */
double fsi_t_end(const fsi_fluid* fluid);
/* The next surface: 1; 0: the solid has finished, nothing may be sent any more. */
int fsi_recv_surface(fsi_fluid* fluid, fsi_surface* surface);
/* Velocity of the fluid's walls in a window that ends at t1, constant over it, so that they end where the solid is
 * expected: m/s at the nodes [n_nodes][3] and the means of the faces' nodes [n_faces][3]; either may be NULL. Not
 * collective. */
void fsi_wall_velocity(fsi_fluid* fluid, double t1, double* nodes, double* faces);
/* Answers the surface in hand; impulse, moment and work for the ledger are made here. */
void fsi_send_load(fsi_fluid* fluid, const fsi_load* load);

/* Ends both programs with `code` (1 to 63; 0 becomes 70) and the reason. Any rank, any time; fluid may be NULL before
 * fsi_fluid_open. */
void fsi_fail(fsi_fluid* fluid, int code, const char* text);
/* Ends the program here if the other one has failed; for long computations, about 1 us. Rank 0. */
void fsi_poll(fsi_fluid* fluid);
/* After fsi_recv_surface gave 0, otherwise the run is ended with code 71. Frees. */
void fsi_close(fsi_fluid* fluid);

/* The fluid's own ranks. fsi_comm is its communicator as a Fortran handle: MPI_Comm_f2c(fsi_comm(fluid)). Not
 * collective. */
int fsi_rank(const fsi_fluid* fluid);
int fsi_size(const fsi_fluid* fluid);
int fsi_comm(const fsi_fluid* fluid);
/* values [n] becomes the sum over the ranks, in rank order, the same bits on all. */
void fsi_sum(fsi_fluid* fluid, double* values, int64_t n);

#ifdef __cplusplus
}
#endif
