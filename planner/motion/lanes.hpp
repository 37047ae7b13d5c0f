// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

/// Functions without branches and without calls, so that a loop over some of them at once becomes vector instructions.
/// The same bits on every processor, which those of the C library do not promise. Reentrant.
namespace footlight::planner::lanes {

/// So many are computed at once: a multiple of every vector's doubles.
inline constexpr std::size_t kLanes = 8;

/// e^x, within 2 ulp; of less than -700 and more than 700 that of the limit.
/// Source: Cody and Waite's reduction, x = n ln 2 + r, |r| <= ln 2 / 2, ln 2 in two parts as in fdlibm's e_exp.c; e^r
/// by its series to r^13.
[[nodiscard]] inline double exp(double x) {
  constexpr double kRound = 0x1.8p52;  // adding it rounds to a whole number, which the low bits then are
  const double at_least = x > -700.0 ? x : -700.0;
  const double bounded = at_least < 700.0 ? at_least : 700.0;
  const double shifted = bounded * 0x1.71547652b82fep0 + kRound;
  const double n = shifted - kRound;
  const double r = (bounded - n * 0x1.62e42feep-1) - n * 0x1.a39ef35793c76p-33;
  // In pairs, pairs of pairs, ... (Estrin): each term need not wait for the one before.
  const double r2 = r * r;
  const double r4 = r2 * r2;
  const double r8 = r4 * r4;
  const double first = (1.0 + r) + r2 * (0.5 + r * (1.0 / 6.0));
  const double second = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0));
  const double third = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0));
  const double fourth = 1.0 / 479001600.0 + r * (1.0 / 6227020800.0);
  const double sum = (first + r4 * second) + r8 * (third + r4 * fourth);
  return sum * std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023U) << 52U);
}

struct SineCosine {
  double sine;
  double cosine;
};

/// Of an angle in [-pi, pi], within 2e-15: the series of its half, doubled.
[[nodiscard]] inline SineCosine sine_cosine(double angle_rad) {
  const double half = 0.5 * angle_rad;
  const double z = half * half;
  double sine = -1.0 / 121645100408832000.0;
  sine = sine * z + 1.0 / 355687428096000.0;
  sine = sine * z - 1.0 / 1307674368000.0;
  sine = sine * z + 1.0 / 6227020800.0;
  sine = sine * z - 1.0 / 39916800.0;
  sine = sine * z + 1.0 / 362880.0;
  sine = sine * z - 1.0 / 5040.0;
  sine = sine * z + 1.0 / 120.0;
  sine = sine * z - 1.0 / 6.0;
  sine = (sine * z + 1.0) * half;
  double cosine = 1.0 / 2432902008176640000.0;
  cosine = cosine * z - 1.0 / 6402373705728000.0;
  cosine = cosine * z + 1.0 / 20922789888000.0;
  cosine = cosine * z - 1.0 / 87178291200.0;
  cosine = cosine * z + 1.0 / 479001600.0;
  cosine = cosine * z - 1.0 / 3628800.0;
  cosine = cosine * z + 1.0 / 40320.0;
  cosine = cosine * z - 1.0 / 720.0;
  cosine = cosine * z + 1.0 / 24.0;
  cosine = cosine * z - 0.5;
  cosine = cosine * z + 1.0;
  return {2.0 * sine * cosine, 1.0 - 2.0 * sine * sine};
}

}  // namespace footlight::planner::lanes
