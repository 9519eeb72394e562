/* Times a function that CasADi wrote, as flexure/clock.rs does: driver FILE OUT MILLISECONDS. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

int work(const double** arg, double** res, long long* iw, double* w, int mem);
const long long* work_sparsity_in(long long i);
const long long* work_sparsity_out(long long i);

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  size_t inputs = (size_t)work_sparsity_in(0)[0], outputs = (size_t)work_sparsity_out(0)[0];
  FILE* file = fopen(argv[1], "rb");
  fseek(file, 0, SEEK_END);
  size_t lines = (size_t)ftell(file) / sizeof(double) / inputs;
  rewind(file);
  double* x = malloc(lines * inputs * sizeof(double));
  double* y = malloc(lines * outputs * sizeof(double));
  if (fread(x, sizeof(double), lines * inputs, file) != lines * inputs) return 1;
  double least = 1e300, w[1];
  long long iw[1];
  for (double end = now() + 1e6 * atof(argv[3]), start; (start = now()) < end || least > 1e299;) {
    for (size_t i = 0; i < lines; i++) {
      const double* arg[1] = {x + i * inputs};
      double* res[1] = {y + i * outputs};
      if (work(arg, res, iw, w, 0)) return 1;
    }
    double took = now() - start;
    if (took < least) least = took;
  }
  file = fopen(argv[2], "wb");
  fwrite(y, sizeof(double), lines * outputs, file);
  fclose(file);
  printf("%.17g\n", least / (double)lines);
  return 0;
}
