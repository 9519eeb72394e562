// What both programs of Pinocchio share: the arm, reading, timing.
#pragma once
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <pinocchio/multibody.hpp>

namespace pin = pinocchio;
using Vector = Eigen::VectorXd;
using Map = Eigen::Map<const Vector>;
using Out = Eigen::Map<Vector>;

inline double now() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Work {
  long inputs, outputs;
  std::function<void(const double*, double*)> run;
};

// Revolute joints about z, one after the other: gravity, then for each rotation, translation, mass, centre of mass, inertia about it.
inline pin::Model arm(const std::vector<double>& x) {
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

inline std::vector<double> numbers(const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const double* x = reinterpret_cast<const double*>(bytes.data());
  return {x, x + bytes.size() / sizeof(double)};
}

// Times a work on the lines of FILE, as driver.c does.
inline void measure(const Work& work, const char* file, const char* out, const char* milliseconds) {
  const std::vector<double> x = numbers(file);
  const long lines = static_cast<long>(x.size()) / work.inputs;
  std::vector<double> y(static_cast<std::size_t>(lines * work.outputs));
  double least = 1e300;
  for (double end = now() + 1e6 * std::atof(milliseconds), start; (start = now()) < end || least > 1e299;) {
    for (long i = 0; i < lines; i++) work.run(x.data() + i * work.inputs, y.data() + i * work.outputs);
    least = std::min(least, now() - start);
  }
  std::ofstream(out, std::ios::binary)
      .write(reinterpret_cast<const char*>(y.data()), static_cast<std::streamsize>(y.size() * sizeof(double)));
  std::printf("%.17g\n", least / static_cast<double>(lines));
}
