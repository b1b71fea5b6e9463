// SPDX-License-Identifier: BSD-3-Clause
// Families of modulus reduction and damping curves; sources in fem/material/soil_curve.hpp. The digitised numbers are
// the same in both programs named there.
#include "fem/material/soil_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double percent = 0.01, atmosphere = 101.325e3, foot = 0.3048;

/// Damping ratio of Masing loops on the backbone x/(1 + x^a), x = gamma/gamma_r: that of the hyperbola (a = 1), and
/// Darendeli's polynomial, which takes it in per cent.
double masing_damping(double x, double a)
{
  const double hyperbola = x < 1e-4 ? 200 * x / (3 * std::numbers::pi) // its limit; below, round-off
                                    : 100 / std::numbers::pi * (4 * (x - std::log1p(x)) * (1 + x) / (x * x) - 2);
  const double c1 = -1.1143 * a * a + 1.8618 * a + 0.2523, c2 = 0.0805 * a * a - 0.0710 * a - 0.0095,
               c3 = -0.0005 * a * a + 0.0002 * a + 0.0003;
  return percent * hyperbola * (c1 + hyperbola * (c2 + hyperbola * c3));
}

/// From 1e-6 to 1 %, twenty strains a decade.
SoilCurve modified_hyperbola(double reference_strain, double exponent, double least_damping)
{
  const double b = 0.6329 - 0.00566 * std::log(10.0); // of 10 cycles
  SoilCurve curve;
  double most = 0;
  for (int k = 0; k <= 80; ++k)
    {
      const double strain = std::pow(10.0, -6 + k / 20.0), x = strain / reference_strain,
                   reduction = 1 / (1 + std::pow(x, exponent));
      most = std::max(most, b * std::pow(reduction, 0.1) * masing_damping(x, exponent));
      curve.strains.push_back(strain);
      curve.reduction.push_back(reduction);
      curve.damping.push_back(most + least_damping);
    }
  return curve;
}

template <std::size_t n>
struct Digitised
{
  double upper; ///< plasticity index in per cent, or end of the depths in feet
  std::array<double, n> reduction, damping;
};

constexpr std::array<double, 9> strains_of_vucetic_dobry = {1e-6,    3.16e-6, 1e-5,    3.16e-5, 1e-4,
                                                            3.16e-4, 1e-3,    3.16e-3, 1e-2};
// clang-format off
constexpr Digitised<9> vucetic_dobry[] = {
  {0,   {1, 1, 0.96, 0.88, 0.70, 0.47, 0.26, 0.11, 0.03},
        {0.01, 0.01, 0.01, 0.030, 0.054, 0.098, 0.150, 0.203, 0.240}},
  {15,  {1, 1, 0.99, 0.94, 0.81, 0.64, 0.41, 0.22, 0.10},
        {0.01, 0.01, 0.01, 0.026, 0.045, 0.075, 0.116, 0.160, 0.200}},
  {30,  {1, 1, 1, 0.98, 0.90, 0.75, 0.53, 0.35, 0.17},
        {0.01, 0.01, 0.01, 0.021, 0.038, 0.059, 0.088, 0.125, 0.169}},
  {50,  {1, 1, 1, 1, 0.95, 0.84, 0.67, 0.47, 0.25},
        {0.01, 0.01, 0.01, 0.018, 0.029, 0.043, 0.062, 0.095, 0.135}},
  {100, {1, 1, 1, 1, 0.98, 0.92, 0.81, 0.63, 0.37},
        {0.01, 0.01, 0.01, 0.015, 0.020, 0.029, 0.041, 0.065, 0.098}},
  {200, {1, 1, 1, 1, 1, 0.96, 0.89, 0.75, 0.53},
        {0.01, 0.01, 0.01, 0.013, 0.016, 0.021, 0.030, 0.048, 0.081}},
};

constexpr std::array<double, 17> strains_of_epri = {
  1e-6, 1.778e-6, 3.162e-6, 5.623e-6, 1e-5, 1.778e-5, 3.162e-5, 5.623e-5, 1e-4, 1.778e-4, 3.162e-4, 5.623e-4, 1e-3,
  1.778e-3, 3.162e-3, 5.623e-3, 1e-2};
constexpr Digitised<17> epri[] = {
  {20,   {1, 1, 1, 0.998, 0.986, 0.960, 0.920, 0.851, 0.759, 0.642, 0.515, 0.392, 0.278, 0.189, 0.121, 0.073, 0.043},
         {0.01429, 0.01476, 0.01536, 0.01602, 0.01879, 0.02193, 0.02819, 0.03724, 0.05066, 0.06940, 0.09346, 0.12201,
          0.15443, 0.18703, 0.21704, 0.24541, 0.27217}},
  {50,   {1, 1, 1, 0.999, 0.993, 0.979, 0.952, 0.903, 0.830, 0.733, 0.617, 0.488, 0.366, 0.258, 0.173, 0.108, 0.066},
         {0.01142, 0.01196, 0.01250, 0.01304, 0.01469, 0.01670, 0.02074, 0.02658, 0.03622, 0.05066, 0.07069, 0.09569,
          0.12500, 0.15688, 0.19004, 0.22022, 0.24699}},
  {120,  {1, 1, 1, 0.999, 0.998, 0.988, 0.970, 0.934, 0.878, 0.797, 0.691, 0.567, 0.444, 0.328, 0.225, 0.145, 0.092},
         {0.01000, 0.00982, 0.00978, 0.01122, 0.01165, 0.01371, 0.01610, 0.02046, 0.02830, 0.03901, 0.05493, 0.07662,
          0.10381, 0.13383, 0.16643, 0.19766, 0.22580}},
  {250,  {1, 1, 1, 0.999, 0.999, 0.994, 0.979, 0.954, 0.909, 0.840, 0.747, 0.631, 0.507, 0.384, 0.274, 0.182, 0.118},
         {0.00857, 0.00839, 0.00821, 0.00880, 0.01006, 0.01125, 0.01341, 0.01629, 0.02198, 0.03131, 0.04460, 0.06281,
          0.08686, 0.11573, 0.14770, 0.17879, 0.20906}},
  {500,  {1, 1, 1, 0.999, 0.999, 0.999, 0.986, 0.968, 0.934, 0.879, 0.799, 0.696, 0.575, 0.449, 0.332, 0.230, 0.148},
         {0.00786, 0.00792, 0.00799, 0.00811, 0.00867, 0.00950, 0.01081, 0.01344, 0.01774, 0.02515, 0.03520, 0.05077,
          0.07206, 0.09853, 0.12839, 0.15972, 0.19072}},
  {1000, {1, 1, 1, 1, 1, 1, 0.995, 0.982, 0.960, 0.915, 0.850, 0.765, 0.660, 0.532, 0.410, 0.297, 0.200},
         {0.00492, 0.00554, 0.00607, 0.00589, 0.00643, 0.00696, 0.00772, 0.00983, 0.01234, 0.01735, 0.02562, 0.03696,
          0.05408, 0.07617, 0.10428, 0.13524, 0.16459}},
};
// clang-format on
} // namespace

SoilCurve darendeli_curve(double pressure, double plasticity, double ocr)
{
  const double p = pressure / atmosphere;
  return modified_hyperbola(percent * (0.0352 + 0.0010 * plasticity * std::pow(ocr, 0.3246)) * std::pow(p, 0.3483),
                            0.9190,
                            percent * (0.8005 + 0.0129 * plasticity * std::pow(ocr, -0.1069)) * std::pow(p, -0.2889));
}

SoilCurve menq_curve(double pressure, double uniformity, double d50)
{
  const double p = pressure / atmosphere;
  return modified_hyperbola(
      percent * 0.12 * std::pow(uniformity, -0.6) * std::pow(p, 0.5 * std::pow(uniformity, -0.15)),
      0.86 + 0.1 * std::log10(p),
      percent * 0.55 * std::pow(uniformity, 0.1) * std::pow(1e3 * d50, -0.3) * std::pow(p, -0.08));
}

SoilCurve vucetic_dobry_curve(double plasticity)
{
  const auto *b = std::find_if(std::begin(vucetic_dobry) + 1, std::end(vucetic_dobry) - 1,
                               [&](const auto &of) { return plasticity <= of.upper; });
  const auto *a = b - 1;
  const double part = (plasticity - a->upper) / (b->upper - a->upper);
  SoilCurve curve{{strains_of_vucetic_dobry.begin(), strains_of_vucetic_dobry.end()}, {}, {}};
  for (std::size_t k = 0; k < curve.strains.size(); ++k)
    {
      curve.reduction.push_back(std::lerp(a->reduction[k], b->reduction[k], part));
      curve.damping.push_back(std::lerp(a->damping[k], b->damping[k], part));
    }
  return curve;
}

SoilCurve epri_curve(double depth)
{
  const auto *of = std::find_if(std::begin(epri), std::end(epri) - 1,
                                [&](const auto &range) { return depth <= foot * range.upper; });
  return {{strains_of_epri.begin(), strains_of_epri.end()},
          {of->reduction.begin(), of->reduction.end()},
          {of->damping.begin(), of->damping.end()}};
}
} // namespace isostat
