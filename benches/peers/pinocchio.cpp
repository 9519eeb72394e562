// Pinocchio's side: pinocchio ROBOT WORK FILE OUT MILLISECONDS, as driver.c has it for CasADi.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "jet.hpp"
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody.hpp>

namespace pin = pinocchio;
using Vector = Eigen::VectorXd;
using Map = Eigen::Map<const Vector>;
using Out = Eigen::Map<Vector>;

static double now() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Work {
  long inputs, outputs;
  std::function<void(const double*, double*)> run;
};

// Revolute joints about z, one after the other: gravity, then for each rotation, translation, mass, centre of mass, inertia about it.
static pin::Model arm(const std::vector<double>& x) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  pin::Model model;
  model.gravity.linear() = Eigen::Map<const Eigen::Vector3d>(x.data());
  pin::JointIndex parent = 0;
  for (const double* b = x.data() + 3; b < x.data() + x.size(); b += 25) {
    const pin::SE3 place(Eigen::Map<const Rows>(b), Eigen::Map<const Eigen::Vector3d>(b + 9));
    parent = model.addJoint(parent, pin::JointModelRZ(), place, "joint" + std::to_string(parent));
    const pin::Inertia body(b[12], Eigen::Map<const Eigen::Vector3d>(b + 13), Eigen::Map<const Rows>(b + 16));
    model.appendBodyToJoint(parent, body, pin::SE3::Identity());
  }
  return model;
}

static std::vector<double> numbers(const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const double* x = reinterpret_cast<const double*>(bytes.data());
  return {x, x + bytes.size() / sizeof(double)};
}

// RNEA on Taylor series of three coefficients: the torque with two rates.
static Work rates(const pin::Model& model) {
  using Series = Eigen::Matrix<Jet, Eigen::Dynamic, 1>;
  static auto jets = model.cast<Jet>();
  static pin::DataTpl<Jet> data(jets);
  static Series q(model.nv), v(model.nv), a(model.nv);
  long n = model.nv;
  return {5 * n, 3 * n, [n](const double* x, double* y) {
            for (long i = 0; i < n; i++) {
              const double q0 = x[i], v0 = x[n + i], a0 = x[2 * n + i], j = x[3 * n + i], s = x[4 * n + i];
              q[i] = Jet(q0, v0, a0 / 2), v[i] = Jet(v0, a0, j / 2), a[i] = Jet(a0, j, s / 2);
            }
            const auto& tau = pin::rnea(jets, data, q, v, a);
            for (long i = 0; i < n; i++) y[i] = tau[i].c[0], y[n + i] = tau[i].c[1], y[2 * n + i] = 2 * tau[i].c[2];
          }};
}

static Work work(const std::string& name, const pin::Model& model, pin::Data& data) {
  long n = model.nv;
  if (name == "rnea7")
    return {3 * n, n, [&, n](const double* x, double* y) {
              Out(y, n) = pin::rnea(model, data, Map(x, n), Map(x + n, n), Map(x + 2 * n, n));
            }};
  if (name == "fd7")
    return {3 * n, n, [&, n](const double* x, double* y) {
              Out(y, n) = pin::aba(model, data, Map(x, n), Map(x + n, n), Map(x + 2 * n, n));
            }};
  if (name == "crba7")
    return {n, n * n, [&, n](const double* x, double* y) {
              Eigen::Map<Eigen::MatrixXd> mass(y, n, n);
              mass = pin::crba(model, data, Map(x, n));
              mass.triangularView<Eigen::StrictlyLower>() = mass.transpose().triangularView<Eigen::StrictlyLower>();
            }};
  if (name == "rates7") return rates(model);
  std::exit(2);
}

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const pin::Model model = arm(numbers(argv[1]));
  pin::Data data(model);
  const Work one = work(argv[2], model, data);
  const std::vector<double> x = numbers(argv[3]);
  const long lines = static_cast<long>(x.size()) / one.inputs;
  std::vector<double> y(static_cast<std::size_t>(lines * one.outputs));
  double least = 1e300;
  for (double end = now() + 1e6 * std::atof(argv[5]), start; (start = now()) < end || least > 1e299;) {
    for (long i = 0; i < lines; i++) one.run(x.data() + i * one.inputs, y.data() + i * one.outputs);
    least = std::min(least, now() - start);
  }
  std::ofstream(argv[4], std::ios::binary)
      .write(reinterpret_cast<const char*>(y.data()), static_cast<std::streamsize>(y.size() * sizeof(double)));
  std::printf("%.17g\n", least / static_cast<double>(lines));
}
