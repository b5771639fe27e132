#include "core/geometry/determinant_sign.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace adamas::inline core {

namespace {

/// A number as a sum of floating-point numbers, by ascending size, without zeros and without overlaps.
template <class Real>
using Expansion = std::vector<Real>;

/// Products of four doubles, and the rounding errors of these, are within the range of these numbers.
using Wide = long double;
static_assert(std::numeric_limits<Wide>::min_exponent < -8000 &&
              std::numeric_limits<Wide>::max_exponent > 8000);

/// Whether products of the entries, and their rounding errors, are within the range of doubles.
bool is_ordinary(const SmallMatrix& matrix, std::size_t n) {
  constexpr double kLeast = 0x1p-200, kGreatest = 0x1p200;
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) {
      const double size = std::abs(matrix[row][column]);
      if (size != 0 && !(size > kLeast && size < kGreatest)) return false;
    }
  }
  return true;
}

/// The rounding error of a + b, exactly.
template <class Real>
Real rounding_error(Real a, Real b, Real sum) {
  const Real from_b = sum - a, from_a = sum - from_b;
  return (a - from_a) + (b - from_b);
}

/// Appends the rounding error of a + b, if any, and returns the rounded sum.
template <class Real>
Real add(Real a, Real b, Expansion<Real>& errors) {
  const Real sum = a + b, error = rounding_error(a, b, sum);
  if (error != 0) errors.push_back(error);
  return sum;
}

template <class Real>
Expansion<Real> sum_of(const Expansion<Real>& e, const Expansion<Real>& f) {
  if (e.empty()) return f;
  if (f.empty()) return e;
  Expansion<Real> result;
  result.reserve(e.size() + f.size());
  std::size_t i = 0, j = 0;
  const auto next = [&] {
    return j == f.size() || (i < e.size() && std::abs(e[i]) < std::abs(f[j])) ? e[i++] : f[j++];
  };
  Real carried = next();
  while (i < e.size() || j < f.size()) carried = add(carried, next(), result);
  if (carried != 0) result.push_back(carried);
  return result;
}

template <class Real>
Expansion<Real> product_of(const Expansion<Real>& e, Real factor) {
  Expansion<Real> result;
  if (factor == 0) return result;
  result.reserve(2 * e.size());
  Real carried = 0;
  for (const Real part : e) {
    const Real high = part * factor, low = std::fma(part, factor, -high);
    const Real middle = add(carried, low, result);
    carried = add(high, middle, result);
  }
  if (carried != 0) result.push_back(carried);
  return result;
}

/// Determinants of the first rows and the columns in each set, by Laplace expansion along the last of the
/// rows. `Number` offers zero, one, and sums and products by the given functions.
template <class Number, class Accumulate>
Number determinant(std::size_t n, const Number& zero, const Number& one, Accumulate&& accumulate) {
  std::array<Number, 32> minors;
  minors.fill(zero);
  minors[0] = one;
  for (unsigned set = 1; set < 1u << n; ++set) {
    std::size_t row = 0;
    for (unsigned rest = set; rest != 0; rest &= rest - 1) ++row;
    bool negative = row % 2 == 0;
    for (std::size_t column = 0; column < n; ++column) {
      if ((set >> column & 1u) == 0) continue;
      accumulate(minors[set], minors[set & ~(1u << column)], row - 1, column, negative);
      negative = !negative;
    }
  }
  return minors[(1u << n) - 1];
}

template <class Real>
Expansion<Real> exact_determinant(const SmallMatrix& matrix, std::size_t n) {
  using Number = Expansion<Real>;
  return determinant<Number>(
      n, Number{}, Number{1},
      [&](Number& sum, const Number& minor, std::size_t row, std::size_t column, bool negative) {
        const Real entry = matrix[row][column];
        sum = sum_of(sum, product_of(minor, negative ? -entry : entry));
      });
}

template <class Real>
int sign_of(const Expansion<Real>& number) {
  return number.empty() ? 0 : number.back() > 0 ? 1 : -1;
}

template <class Real>
Real value_of(const Expansion<Real>& number) {
  Real sum = 0;
  for (const Real part : number) sum += part;
  return sum;
}

/// A sum, and the sum of the absolute values of its terms.
struct Bounded {
  double value = 0, size = 0;

  friend Bounded operator*(const Bounded& a, const Bounded& b) {
    return {a.value * b.value, a.size * b.size};
  }
  friend Bounded operator+(const Bounded& a, const Bounded& b) {
    return {a.value + b.value, a.size + b.size};
  }
  friend Bounded operator-(const Bounded& a, const Bounded& b) {
    return {a.value - b.value, a.size + b.size};
  }
};

/// The determinant in floating point and a bound of its error.
Bounded rounded_determinant(const SmallMatrix& matrix, std::size_t n) {
  const auto at = [&](std::size_t row, std::size_t column) {
    const double entry = matrix[row][column];
    return Bounded{entry, std::abs(entry)};
  };
  // The minor of rows r and r + 1 and columns i and j.
  const auto minor = [&](std::size_t r, std::size_t i, std::size_t j) {
    return at(r, i) * at(r + 1, j) - at(r, j) * at(r + 1, i);
  };
  Bounded found;
  if (n == 1) {
    found = at(0, 0);
  } else if (n == 2) {
    found = minor(0, 0, 1);
  } else if (n == 3) {
    found = at(2, 0) * minor(0, 1, 2) - at(2, 1) * minor(0, 0, 2) + at(2, 2) * minor(0, 0, 1);
  } else if (n == 4) {
    found = minor(0, 0, 1) * minor(2, 2, 3) - minor(0, 0, 2) * minor(2, 1, 3) +
            minor(0, 0, 3) * minor(2, 1, 2) + minor(0, 1, 2) * minor(2, 0, 3) -
            minor(0, 1, 3) * minor(2, 0, 2) + minor(0, 2, 3) * minor(2, 0, 1);
  } else {
    found = determinant<Bounded>(
        n, {0, 0}, {1, 1},
        [&](Bounded& sum, const Bounded& rest, std::size_t row, std::size_t column, bool negative) {
          const Bounded term = at(row, column) * rest;
          sum = negative ? sum - term : sum + term;
        });
  }
  // The number of roundings between an entry and the result, and one for those of the size.
  constexpr std::array<double, 6> kRoundings{0, 1, 3, 6, 11, 60};
  found.size *= kRoundings[n] * std::numeric_limits<double>::epsilon() / 2;
  return found;
}

/// A whole number of 256 bits, in two's complement, the lowest word first.
class WholeNumber {
 public:
  explicit WholeNumber(std::int64_t value = 0) {
    words_.fill(value < 0 ? ~std::uint64_t{0} : 0);
    words_[0] = static_cast<std::uint64_t>(value);
  }
  [[nodiscard]] int sign() const {
    if (static_cast<std::int64_t>(words_[3]) < 0) return -1;
    return (words_[0] | words_[1] | words_[2] | words_[3]) != 0 ? 1 : 0;
  }
  /// Adds the product of two numbers, or subtracts it.
  void add_product(const WholeNumber& a, std::int64_t b, bool negative) {
    if (b == 0 || a.sign() == 0) return;
    // For a negative b the factor is its two's complement, which has 2^64 too much.
    const auto factor = static_cast<std::uint64_t>(b);
    WholeNumber product;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Twice sum = Twice{a.words_[i]} * factor + carry;
      product.words_[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    if (b < 0) {
      WholeNumber shifted;
      for (std::size_t i = 1; i < 4; ++i) shifted.words_[i] = a.words_[i - 1];
      product.add(shifted, true);
    }
    add(product, negative);
  }

 private:
  __extension__ using Twice = unsigned __int128;

  void add(const WholeNumber& a, bool negative) {
    std::uint64_t carry = negative ? 1 : 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Twice sum = Twice{words_[i]} + (negative ? ~a.words_[i] : a.words_[i]) + carry;
      words_[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
  }

  std::array<std::uint64_t, 4> words_{};
};

/// Entries of at most so many bits have determinants of five rows that are within the range of WholeNumber.
constexpr int kMostBits = 49;

/// The entries of a column as multiples of a power of two; none if that takes too many bits.
std::optional<std::array<std::int64_t, 5>> whole_column(const SmallMatrix& matrix, std::size_t n,
                                                        std::size_t column) {
  constexpr int kMantissa = std::numeric_limits<double>::digits;
  std::array<std::int64_t, 5> mantissas{}, result{};
  std::array<int, 5> exponents{};
  int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
  for (std::size_t row = 0; row < n; ++row) {
    const double entry = matrix[row][column];
    if (entry == 0) continue;
    mantissas[row] = static_cast<std::int64_t>(std::ldexp(std::frexp(entry, &exponents[row]), kMantissa));
    exponents[row] -= kMantissa;
    highest = std::max(highest, exponents[row] + kMantissa);
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissas[row]));
    mantissas[row] >>= zeros;
    exponents[row] += zeros;
    lowest = std::min(lowest, exponents[row]);
  }
  if (highest > lowest && highest - lowest > kMostBits) return {};
  for (std::size_t row = 0; row < n; ++row) {
    if (mantissas[row] != 0) result[row] = mantissas[row] * (std::int64_t{1} << (exponents[row] - lowest));
  }
  return result;
}

/// The sign of the determinant in whole numbers, if the entries of each column are multiples of some number
/// with few bits; else none.
std::optional<int> whole_determinant_sign(const SmallMatrix& matrix, std::size_t n) {
  std::array<std::array<std::int64_t, 5>, 5> columns;
  for (std::size_t column = 0; column < n; ++column) {
    const auto whole = whole_column(matrix, n, column);
    if (!whole) return {};
    columns[column] = *whole;
  }
  return determinant<WholeNumber>(
             n, WholeNumber(0), WholeNumber(1),
             [&](WholeNumber& sum, const WholeNumber& minor, std::size_t row, std::size_t column,
                 bool negative) { sum.add_product(minor, columns[column][row], negative); })
      .sign();
}

/// Makes a smaller matrix with the same determinant if the last column consists of ones and zeros: a row that
/// ends in one is subtracted from the others, where that is exact. Otherwise leaves the matrix as it is.
void reduce(SmallMatrix& matrix, std::size_t& n) {
  std::size_t base = n;
  for (std::size_t row = n; row-- > 0;) {
    const double last = matrix[row][n - 1];
    if (last == 1) base = row;
    if (last != 0 && last != 1) return;
  }
  if (base == n || n == 1) return;
  SmallMatrix smaller{};
  std::size_t to = 0;
  for (std::size_t row = 0; row < n; ++row) {
    if (row == base) continue;
    for (std::size_t column = 0; column + 1 < n; ++column) {
      const double entry = matrix[row][column];
      const double subtracted = matrix[row][n - 1] == 1 ? matrix[base][column] : 0;
      const double difference = entry - subtracted;
      if (rounding_error(entry, -subtracted, difference) != 0) return;
      // The sign comes from the expansion along the last column.
      smaller[to][column] = to == 0 && (base + n) % 2 == 0 ? -difference : difference;
    }
    ++to;
  }
  matrix = smaller;
  --n;
}

}  // namespace

int determinant_sign(SmallMatrix matrix, std::size_t n) {
  reduce(matrix, n);
  if (!is_ordinary(matrix, n)) return sign_of(exact_determinant<Wide>(matrix, n));
  const auto [value, error] = rounded_determinant(matrix, n);
  if (value > error) return 1;
  if (value < -error) return -1;
  if (error == 0) return 0;
  if (const auto sign = whole_determinant_sign(matrix, n)) return *sign;
  return sign_of(exact_determinant<double>(matrix, n));
}

long double determinant_value(SmallMatrix matrix, std::size_t n) {
  reduce(matrix, n);
  if (!is_ordinary(matrix, n)) return value_of(exact_determinant<Wide>(matrix, n));
  const auto [value, error] = rounded_determinant(matrix, n);
  if (error <= 5e-13 * std::abs(value)) return value;
  return value_of(exact_determinant<double>(matrix, n));
}

}  // namespace adamas::inline core
