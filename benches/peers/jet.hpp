// A number for Pinocchio's templates: a Taylor series in time of three coefficients.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <ostream>

struct Jet {
  double c[3];
  Jet() : c{0, 0, 0} {}
  Jet(double x) : c{x, 0, 0} {}
  Jet(int x) : c{double(x), 0, 0} {}
  Jet(double x, double y, double z) : c{x, y, z} {}
  explicit operator double() const { return c[0]; }
  Jet operator-() const { return {-c[0], -c[1], -c[2]}; }
  Jet& operator+=(const Jet& o) { return *this = {c[0] + o.c[0], c[1] + o.c[1], c[2] + o.c[2]}; }
  Jet& operator-=(const Jet& o) { return *this = {c[0] - o.c[0], c[1] - o.c[1], c[2] - o.c[2]}; }
  Jet& operator*=(const Jet& o) {
    return *this = {c[0] * o.c[0], c[0] * o.c[1] + c[1] * o.c[0], c[0] * o.c[2] + c[1] * o.c[1] + c[2] * o.c[0]};
  }
  Jet& operator/=(const Jet& o) {
    double x = c[0] / o.c[0], y = (c[1] - x * o.c[1]) / o.c[0];
    return *this = {x, y, (c[2] - x * o.c[2] - y * o.c[1]) / o.c[0]};
  }
};
inline Jet operator+(Jet a, const Jet& b) { return a += b; }
inline Jet operator-(Jet a, const Jet& b) { return a -= b; }
inline Jet operator*(Jet a, const Jet& b) { return a *= b; }
inline Jet operator/(Jet a, const Jet& b) { return a /= b; }
inline bool operator<(const Jet& a, const Jet& b) { return a.c[0] < b.c[0]; }
inline bool operator>(const Jet& a, const Jet& b) { return a.c[0] > b.c[0]; }
inline bool operator<=(const Jet& a, const Jet& b) { return a.c[0] <= b.c[0]; }
inline bool operator>=(const Jet& a, const Jet& b) { return a.c[0] >= b.c[0]; }
inline bool operator==(const Jet& a, const Jet& b) { return a.c[0] == b.c[0] && a.c[1] == b.c[1] && a.c[2] == b.c[2]; }
inline bool operator!=(const Jet& a, const Jet& b) { return !(a == b); }
inline std::ostream& operator<<(std::ostream& out, const Jet& x) { return out << x.c[0]; }
inline Jet along(const Jet& x, double f, double slope, double curvature) {
  return {f, slope * x.c[1], slope * x.c[2] + curvature * x.c[1] * x.c[1] / 2};
}
inline Jet sin(const Jet& x) { double s = std::sin(x.c[0]), k = std::cos(x.c[0]); return along(x, s, k, -s); }
inline Jet cos(const Jet& x) { double s = std::sin(x.c[0]), k = std::cos(x.c[0]); return along(x, k, -s, -k); }
inline Jet sqrt(const Jet& x) { double r = std::sqrt(x.c[0]); return along(x, r, 0.5 / r, -0.25 / (r * x.c[0])); }
// What Pinocchio's other joints and algorithms must be able to name.
inline Jet atan2(const Jet& y, const Jet& x) { return std::atan2(y.c[0], x.c[0]); }
inline Jet acos(const Jet& x) { return std::acos(x.c[0]); }
inline Jet asin(const Jet& x) { return std::asin(x.c[0]); }
inline Jet tan(const Jet& x) { return sin(x) / cos(x); }
inline Jet exp(const Jet& x) { double e = std::exp(x.c[0]); return along(x, e, e, e); }
inline Jet log(const Jet& x) { return along(x, std::log(x.c[0]), 1 / x.c[0], -1 / (x.c[0] * x.c[0])); }
inline Jet pow(const Jet& x, double p) { return exp(log(x) * p); }
inline Jet abs(const Jet& x) { return x.c[0] < 0 ? -x : x; }
inline bool isfinite(const Jet& x) { return std::isfinite(x.c[0]); }

namespace Eigen {
template <>
struct NumTraits<Jet> : GenericNumTraits<Jet> {
  using Real = Jet;
  using NonInteger = Jet;
  using Nested = Jet;
  using Literal = double;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1, ReadCost = 3, AddCost = 3, MulCost = 6 };
  static Jet epsilon() { return NumTraits<double>::epsilon(); }
  static Jet dummy_precision() { return NumTraits<double>::dummy_precision(); }
  static Jet highest() { return NumTraits<double>::highest(); }
  static Jet lowest() { return NumTraits<double>::lowest(); }
};
}  // namespace Eigen
