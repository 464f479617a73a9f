// A number that counts what is done with it, so that the operations of a law are read off the law itself.
#pragma once

#include <cmath>

#include "base/numbers.hpp"

namespace mappm::bench {

/// In registers, each as wide as the lanes. What depends on the centre and on constants alone is worked out before the
/// loop over its partners and not counted.
struct Operations {
  int multiplications = 0, additions = 0, roots = 0, integers = 0;
};

class Counted {
 public:
  Counted() = default;
  explicit Counted(double value) : value_(value) {}
  /// A number that differs from lane to lane.
  static Counted of_lanes(double value, Operations& operations) {
    Counted number(value);
    number.operations_ = &operations;
    return number;
  }

  friend Counted operator+(const Counted& a, const Counted& b) {
    return a.with(b, a.value_ + b.value_, &Operations::additions);
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    return a.with(b, a.value_ - b.value_, &Operations::additions);
  }
  friend Counted operator*(const Counted& a, const Counted& b) {
    return a.with(b, a.value_ * b.value_, &Operations::multiplications);
  }
  /// As long as a root, and in its place.
  friend Counted operator/(const Counted& a, const Counted& b) {
    return a.with(b, a.value_ / b.value_, &Operations::roots);
  }
  friend Counted to_fixed_with_excess(const Counted& x) { return x.with(x, x.value_, &Operations::additions); }
  static Counted square_root(const Counted& x) { return x.with(x, std::sqrt(x.value_), &Operations::roots); }
  /// Where additions are made.
  static Counted larger(const Counted& a, const Counted& b) {
    return a.with(b, std::fmax(a.value_, b.value_), &Operations::additions);
  }
  static Counted smaller(const Counted& a, const Counted& b) {
    return a.with(b, std::fmin(a.value_, b.value_), &Operations::additions);
  }

 private:
  Counted with(const Counted& other, double value, int Operations::*kind) const {
    Counted result(value);
    result.operations_ = operations_ != nullptr ? operations_ : other.operations_;
    if (result.operations_ != nullptr) ++(result.operations_->*kind);
    return result;
  }

  double value_ = 0.0;
  Operations* operations_ = nullptr;
};

}  // namespace mappm::bench

template <>
struct mappm::NumberType<mappm::bench::Counted> {
  using Number = bench::Counted;
  using Scalar = double;
  static Number square_root(const Number& x) { return Number::square_root(x); }
  static Number larger(const Number& a, const Number& b) { return Number::larger(a, b); }
  static Number smaller(const Number& a, const Number& b) { return Number::smaller(a, b); }
};
