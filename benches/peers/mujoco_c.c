/* MuJoCo's side: mujoco_c MODEL.xml DRIVE INTEGRATOR STEP OUT MILLISECONDS, motions as flexure/motions.rs has them.
   DRIVE: n, amplitude, stiffness, hold[n], q_m0[n]; joints 0..n-1 are the links, n..2n-1 the motors. STEP divides a millisecond.
   Prints the ns of a millisecond; writes q_l and q_m after a second. */
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void move(const mjModel* m, mjData* d, const double* drive, int periods, int steps) {
  int n = (int)drive[0];
  const double *hold = drive + 3, *start = drive + 3 + n;
  mj_resetDataKeyframe(m, d, 0);
  for (int period = 0; period < periods; period++) {
    double t = 1e-3 * period;
    for (int i = 0; i < n; i++)
      d->qfrc_applied[n + i] = hold[i] + drive[1] * sin(8 * t + i) - drive[2] * (d->qpos[n + i] - start[i]);
    for (int step = 0; step < steps; step++) mj_step(m, d);
  }
}

static int integrator(const char* name) {
  if (!strcmp(name, "Euler")) return mjINT_EULER;
  if (!strcmp(name, "RK4")) return mjINT_RK4;
  return mjINT_IMPLICITFAST;
}

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  char error[1000] = "";
  mjModel* m = mj_loadXML(argv[1], NULL, error, sizeof error);
  if (!m) return fprintf(stderr, "%s\n", error), 1;
  double drive[64];
  FILE* file = fopen(argv[2], "rb");
  if (!file || fread(drive, sizeof(double), 64, file) < 5) return 1;
  fclose(file);
  int steps = (int)lround(1e-3 / atof(argv[4]));
  m->opt.timestep = 1e-3 / steps;
  m->opt.integrator = integrator(argv[3]);
  mjData* d = mj_makeData(m);
  move(m, d, drive, 1000, steps);
  file = fopen(argv[5], "wb");
  fwrite(d->qpos, sizeof(double), (size_t)m->nq, file);
  fclose(file);
  double least = 1e300;
  for (double end = now() + 1e6 * atof(argv[6]), start; (start = now()) < end || least > 1e299;) {
    move(m, d, drive, 20, steps);
    double took = now() - start;
    if (took < least) least = took;
  }
  printf("%.17g\n", least / 20);
  return 0;
}
