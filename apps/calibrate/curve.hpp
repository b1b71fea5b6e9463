// SPDX-License-Identifier: BSD-3-Clause
// The curve of a test, measured or computed, and how far two of them are apart.
// tested: tests/apps/calibrate/curve_test.cpp
#pragma once
#include "apps/calibrate/plan.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
/// A monotonic test, row by row. Compression positive, as the files have it; but `strain` grows in the direction of the
/// test, in extension as in compression.
struct Curve
{
  std::vector<double> strain; ///< axial, linear or logarithmic as the laboratory has it [-]
  std::vector<double> q;      ///< axial minus radial stress, Pa
  std::vector<double> other;  ///< drained: volumetric strain [-], from 0; undrained: mean effective stress p', Pa
};

/// Reads history.csv of a finished run of element_test, with the strains of the laboratory's kind.
/// @throws InputError  damaged files
Curve read_model(const std::filesystem::path &folder, const PlanCurve &plan);

/// The strains at which curves are compared: strain_end i/n or strain_end (i/n)^2, i = 1..n, without those before the
/// laboratory's first row [-].
std::vector<double> compared_strains(const Curve &laboratory, const PlanCurve &plan, const MisfitSettings &settings);

/// A laboratory curve and the mean of the model's, at the compared strains.
struct Comparison
{
  Curve laboratory, mean, deviation; ///< deviation: standard deviation over the seeds; 0 for one
  double q_scale = 0, other_scale = 0;
  double misfit = 0; ///< [-]
  /// Of the mean over seeds: its standard error, in the same measure [-]; nothing for one seed.
  std::optional<double> scatter;
};

/// The distance of the mean of the model's curves to the laboratory's, with v the volumetric strain of a drained and p'
/// of an undrained test:
///
///     misfit^2 = 1/(2n) sum_i [ ((q_i - q_i^lab)/max|q^lab|)^2 + ((v_i - v_i^lab)/max|v^lab|)^2 ]
///
/// Maxima over the compared strains; between rows curves are straight. The scatter has the standard error of the mean
/// in place of the differences: a misfit of this size cannot be told from none.
/// @pre one model curve or more, each up to strain_end
/// @throws InputError  a laboratory curve that is zero throughout; a model curve that ends too early
Comparison compare(const Curve &laboratory, const std::vector<Curve> &models, const PlanCurve &plan,
                   const MisfitSettings &settings);

/// sqrt(sum w m^2 / sum w)   @param misfits  of the fitted curves, in the order of `plan`; blind ones are left out
double total_misfit(const std::vector<double> &misfits, const std::vector<PlanCurve> &plan);
} // namespace isostat
