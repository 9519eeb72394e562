// Pinocchio's RNEA on Taylor series of three coefficients, the torque with two rates: as pinocchio.cpp.
#include "jet.hpp"
#include <pinocchio/algorithm/rnea.hpp>

#include "pinocchio.hpp"

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  using Series = Eigen::Matrix<Jet, Eigen::Dynamic, 1>;
  const auto model = arm(numbers(argv[1])).cast<Jet>();
  pin::DataTpl<Jet> data(model);
  const long n = model.nv;
  Series q(n), v(n), a(n);
  const auto run = [&](const double* x, double* y) {
    for (long i = 0; i < n; i++) {
      const double q0 = x[i], v0 = x[n + i], a0 = x[2 * n + i], j = x[3 * n + i], s = x[4 * n + i];
      q[i] = Jet(q0, v0, a0 / 2), v[i] = Jet(v0, a0, j / 2), a[i] = Jet(a0, j, s / 2);
    }
    const auto& tau = pin::rnea(model, data, q, v, a);
    for (long i = 0; i < n; i++) y[i] = tau[i].c[0], y[n + i] = tau[i].c[1], y[2 * n + i] = 2 * tau[i].c[2];
  };
  measure({5 * n, 3 * n, run}, argv[3], argv[4], argv[5]);
}
