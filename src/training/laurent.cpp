#include "training/laurent.h"

#include <algorithm>

namespace filum {
namespace {

std::int64_t wrap_add(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
std::int64_t wrap_multiply(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b));
}
/// The least number has no opposite: it wraps to itself, where a plain minus is undefined.
std::int64_t wrap_negate(std::int64_t a) { return static_cast<std::int64_t>(std::uint64_t{0} - static_cast<std::uint64_t>(a)); }

}  // namespace

Laurent::Laurent(int low, std::vector<std::int64_t> coefficients)
    : low_(low), coefficients_(std::move(coefficients)) {
  trim();
}

void Laurent::trim() {
  while (!coefficients_.empty() && coefficients_.back() == 0) coefficients_.pop_back();
  std::size_t zeros = 0;
  while (zeros < coefficients_.size() && coefficients_[zeros] == 0) ++zeros;
  coefficients_.erase(coefficients_.begin(), coefficients_.begin() + static_cast<std::ptrdiff_t>(zeros));
  low_ = coefficients_.empty() ? 0 : low_ + static_cast<int>(zeros);
}

std::int64_t Laurent::at(int power) const {
  if (zero() || power < low_ || power > high()) return 0;
  return coefficients_[static_cast<std::size_t>(power - low_)];
}

std::int64_t Laurent::at_minus_one() const {
  std::int64_t sum = 0;
  if (zero()) return 0;
  for (int power = low_; power <= high(); ++power)
    sum = wrap_add(sum, power % 2 == 0 ? at(power) : wrap_negate(at(power)));
  return sum;
}

Laurent& Laurent::operator+=(const Laurent& other) {
  if (other.zero()) return *this;
  if (zero()) return *this = other;
  const int low = std::min(low_, other.low_), top = std::max(high(), other.high());
  std::vector<std::int64_t> sum(static_cast<std::size_t>(top - low + 1));
  for (int power = low; power <= top; ++power) {
    sum[static_cast<std::size_t>(power - low)] = wrap_add(at(power), other.at(power));
  }
  low_ = low;
  coefficients_ = std::move(sum);
  trim();
  return *this;
}

Laurent Laurent::operator*(const Laurent& other) const {
  if (zero() || other.zero()) return {};
  std::vector<std::int64_t> product(coefficients_.size() + other.coefficients_.size() - 1, 0);
  for (std::size_t i = 0; i < coefficients_.size(); ++i) {
    for (std::size_t j = 0; j < other.coefficients_.size(); ++j) {
      product[i + j] = wrap_add(product[i + j], wrap_multiply(coefficients_[i], other.coefficients_[j]));
    }
  }
  return Laurent(low_ + other.low_, std::move(product));
}

Laurent Laurent::shifted(int powers) const {
  Laurent result = *this;
  if (!zero()) result.low_ += powers;
  return result;
}

Laurent Laurent::mirrored() const {
  return Laurent(zero() ? 0 : -high(),
                 std::vector<std::int64_t>(coefficients_.rbegin(), coefficients_.rend()));
}

Laurent Laurent::divided(const Laurent& by) const {
  if (zero()) return {};
  std::vector<std::int64_t> rest = coefficients_, quotient;
  const std::int64_t unit = by.coefficients_.front();
  const std::size_t width = by.coefficients_.size();
  for (std::size_t k = 0; k + width <= coefficients_.size(); ++k) {
    const std::int64_t q = wrap_multiply(rest[k], unit);
    quotient.push_back(q);
    for (std::size_t j = 0; j < width; ++j) {
      rest[k + j] = wrap_add(rest[k + j], wrap_multiply(wrap_negate(q), by.coefficients_[j]));
    }
  }
  return Laurent(low_ - by.low_, std::move(quotient));
}

std::string Laurent::text(const std::string& variable) const {
  if (zero()) return "0";
  std::string out;
  for (int power = low_; power <= high(); ++power) {
    const std::int64_t c = at(power);
    if (c == 0) continue;
    if (out.empty()) {
      out += c < 0 ? "-" : "";
    } else {
      out += c < 0 ? " - " : " + ";
    }
    const auto size = static_cast<std::uint64_t>(c < 0 ? wrap_negate(c) : c);
    if (size != 1 || power == 0) out += std::to_string(size);
    if (size != 1 && power != 0) out += ' ';
    if (power != 0) out += variable;
    if (power != 0 && power != 1) out.append("^").append(std::to_string(power));
  }
  return out;
}

}  // namespace filum
