// Pinocchio's side: pinocchio ROBOT WORK FILE OUT MILLISECONDS, as driver.c has it for CasADi.
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "pinocchio.hpp"

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
  std::exit(2);
}

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const pin::Model model = arm(numbers(argv[1]));
  pin::Data data(model);
  measure(work(argv[2], model, data), argv[3], argv[4], argv[5]);
}
