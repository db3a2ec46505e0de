#pragma once
// Laurent polynomials in one variable with whole coefficients, just enough for knot polynomials. Arithmetic
// wraps modulo 2^64: sums that cancel later may overflow on the way, the final coefficients (bounded by the
// knot's determinant) do not.

#include <cstdint>
#include <string>
#include <vector>

namespace filum {

class Laurent {
 public:
  Laurent() = default;
  /// coefficients[k] belongs to the power low + k.
  Laurent(int low, std::vector<std::int64_t> coefficients);
  static Laurent monomial(std::int64_t coefficient, int power) { return Laurent(power, {coefficient}); }

  bool zero() const { return coefficients_.empty(); }
  int low() const { return low_; }
  int high() const { return low_ + static_cast<int>(coefficients_.size()) - 1; }
  std::int64_t at(int power) const;
  /// Value at -1 (for Jones and Alexander polynomials: plus or minus the determinant of the knot).
  std::int64_t at_minus_one() const;

  Laurent& operator+=(const Laurent& other);
  Laurent operator*(const Laurent& other) const;
  Laurent shifted(int powers) const;         // times x^powers
  Laurent mirrored() const;                  // x -> 1/x
  Laurent divided(const Laurent& by) const;  // exact division; lowest coefficient of `by` is +1 or -1
  bool operator==(const Laurent& other) const = default;

  /// "t^-3 - 2 t + 4", variable as given.
  std::string text(const std::string& variable) const;

 private:
  void trim();
  int low_ = 0;
  std::vector<std::int64_t> coefficients_;
};

}  // namespace filum
