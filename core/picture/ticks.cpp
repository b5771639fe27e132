#include "core/picture/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/base/assert.h"

namespace adamas::picture {
namespace {

constexpr int kMostTicks = 1000;

std::string superscript(int exponent) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

std::string with_minus_sign(std::string text) {
  if (!text.empty() && text.front() == '-') text.replace(0, 1, "−");
  return text;
}

std::string without_trailing_zeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string power_label(double mantissa, int exponent) {
  const std::string power = "10" + superscript(exponent);
  const std::string digits = without_trailing_zeros(fmt::format("{:.6g}", mantissa));
  if (digits == "1") return power;
  if (digits == "-1") return "−" + power;
  return with_minus_sign(digits) + "×" + power;
}

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

// The labels of a linear axis: with as many decimals as the step needs, or mantissas times one power of ten.
std::vector<std::string> linear_labels(const std::vector<double>& positions, double step) {
  double greatest = 0;
  for (const double p : positions) greatest = std::max(greatest, std::abs(p));
  const int top = greatest > 0 ? exponent_of(greatest * (1 + 1e-9)) : 0;
  const bool powers = greatest > 0 && (top >= 5 || top <= -4);
  const double scale = powers ? std::pow(10.0, top) : 1;
  const int decimals = std::clamp(-exponent_of(step / scale * (1 + 1e-9)), 0, 15);
  std::vector<std::string> labels;
  for (const double p : positions) {
    const std::string digits = with_minus_sign(fmt::format("{:.{}f}", p / scale, decimals));
    const bool zero = p == 0;
    labels.push_back(zero ? "0" : powers ? digits + "×10" + superscript(top) : digits);
  }
  return labels;
}

}  // namespace

Ticks linear_ticks(double low, double high, int wanted) {
  ADAMAS_ASSERT(std::isfinite(low) && std::isfinite(high) && low <= high);
  Ticks ticks;
  const double range = high - low;
  // For smaller ranges the steps would underflow to 0.
  constexpr double kLeastRange = 1e-290;
  if (!(range > 1e-12 * std::max(std::abs(low), std::abs(high))) || range < kLeastRange ||
      !std::isfinite(range)) {
    ticks.positions = {low};
    ticks.labels = {tidy_number(low)};
    return ticks;
  }
  const double rough = range / std::clamp(wanted, 1, kMostTicks);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  // The multiple is the one of 1, 2, 5 and 10 that is nearest to the wished step, on a logarithmic scale.
  const double multiple = rough / power;
  const double step = power * (multiple < 1.4142 ? 1 : multiple < 3.1623 ? 2 : multiple < 7.0711 ? 5 : 10);
  const double tolerance = 1e-9 * step;
  const double first = std::ceil((low - tolerance) / step), last = std::floor((high + tolerance) / step);
  for (double k = first; k <= last; ++k) ticks.positions.push_back(k == 0 ? 0.0 : k * step);
  if (ticks.positions.empty()) ticks.positions.push_back(0.5 * (low + high));
  ticks.labels = linear_labels(ticks.positions, step);
  return ticks;
}

Ticks log_ticks(double low, double high, int wanted) {
  ADAMAS_ASSERT(low > 0 && low <= high && std::isfinite(high));
  Ticks ticks;
  const double down = low * (1 - 1e-9), up = high * (1 + 1e-9);
  const int first = exponent_of(low) - 1, last = exponent_of(high) + 1;
  std::vector<int> powers;
  for (int e = first; e <= last; ++e) {
    if (const double p = std::pow(10.0, e); p >= down && p <= up) powers.push_back(e);
  }
  const int count = static_cast<int>(powers.size());
  const int stride = std::max(1, (count + std::max(wanted, 1) - 1) / std::max(wanted, 1));
  for (int e = first; e <= last; ++e) {
    for (int m = 1; m <= 9; ++m) {
      const double p = m * std::pow(10.0, e);
      if (p < down || p > up) continue;
      const bool labelled = (m == 1 && e % stride == 0) || (count < 3 && (m == 2 || m == 5));
      if (labelled) {
        ticks.positions.push_back(p);
        const bool plain = count < 3 && last < 5 && first > -4;
        ticks.labels.push_back(plain ? tidy_number(p) : power_label(m, e));
      } else if (m == 1 || stride == 1) {
        ticks.minor.push_back(p);
      }
    }
  }
  if (ticks.positions.empty()) {
    const double middle = std::sqrt(low) * std::sqrt(high);
    ticks.positions.push_back(middle);
    ticks.labels.push_back(tidy_number(middle));
  }
  return ticks;
}

std::string tidy_number(double value) {
  if (std::isnan(value)) return "no data";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  if (value == 0) return "0";
  const int exponent = exponent_of(value);
  if (exponent < -3 || exponent > 5) return power_label(value / std::pow(10.0, exponent), exponent);
  return with_minus_sign(
      without_trailing_zeros(fmt::format("{:.{}f}", value, std::clamp(5 - exponent, 0, 9))));
}

}  // namespace adamas::picture
