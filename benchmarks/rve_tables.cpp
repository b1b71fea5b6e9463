// SPDX-License-Identifier: BSD-3-Clause
// rve_tables: two tables of docs/results/rve.md as Markdown, all from undrained simple shear of periodic packings.
//
//   rotation   how the principal stresses turn, from an isotropic state and from K0 consolidation
//   twisting   what the twisting stiffness alpha_t, which the paper does not give, does to stresses and wave speed
//
//   rve_tables rotation --grains 1000
//   rve_tables twisting --grains 1000 --realisations 3
#include "apps/common/command_line.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/rve/rve.hpp"
#include "tests/support/periodic.hpp"

#include <fmt/format.h>

namespace
{
using namespace isostat;

constexpr double degree = M_PI / 180;

/// An element in undrained simple shear, u_x = gamma y, at the default tolerance of the rate.
class SimpleShear
{
public:
  explicit SimpleShear(const Snapshot &specimen) : rve(specimen, {}) {}

  /// @throws RunFailure  an increment is rejected
  void to(double gamma)
  {
    constexpr int increments = 40;
    const double from = gamma_, part = (gamma - gamma_) / increments;
    for (int k = 1; k <= increments; ++k)
      {
        Mat3 gradient = Mat3::Zero();
        gradient(0, 1) = part;
        const RveResponse response = rve.undrained(gradient);
        if (response.outcome == RveOutcome::rejected)
          throw RunFailure(fmt::format("gamma = {:.3g}, p' = {:.1f} MPa: {}", gamma_, mean() / 1e6, response.reason));
        gamma_ = from + k * part;
      }
    gamma_ = gamma;
  }

  double shear() const { return rve.stress()(0, 1); }
  double mean() const { return -rve.stress().trace() / 3; }
  double vertical() const { return -rve.stress()(1, 1); }
  double lateral() const { return -rve.stress()(0, 0); }

  Rve rve;

private:
  double gamma_ = 0;
};

/// Between the vertical and the direction of the largest compression in the plane of shear, degrees; 45 where the
/// strain increment has it.
double tilt(const SimpleShear &s) { return 0.5 * std::atan2(2 * s.shear(), s.vertical() - s.lateral()) / degree; }

/// Largest difference of stresses in the plane of shear over 2 p': where it is small the directions mean little.
double deviator_ratio(const SimpleShear &s)
{
  return std::hypot(s.shear(), 0.5 * (s.vertical() - s.lateral())) / s.mean();
}

/// Takes the shear stresses off that preparation in an upright cell leaves (some per cent of p'), at the consolidation
/// stresses: all three, or the vertical one without lateral strain.
void free_of_shear(Rve &rve, bool k0)
{
  constexpr double pressure = 200e3;
  MixedIncrement rest;
  rest.stress = -pressure * Mat3::Identity();
  rest.controlled.setConstant(true);
  rest.controlled(0, 0) = rest.controlled(2, 2) = !k0;
  const RveResponse response = rve.advance(rest);
  if (response.outcome == RveOutcome::rejected)
    throw RunFailure(response.reason);
}

void print_rotation(std::uint64_t grains, double degrees, const std::string &consolidation)
{
  const test::CellRecipe recipe{
      .grading = test::small_grading(grains), .degrees = degrees, .consolidation = consolidation};
  SimpleShear shear(test::prepare_in_cell(recipe));
  fmt::print("\n(τ = {:.2f} kPa as prepared)\n", shear.shear() / 1e3);
  free_of_shear(shear.rve, consolidation == "k0");
  fmt::print(
      "\n{} consolidation, {} grains prepared at {:g}°, e = {:.3f}, K0 = {:.2f}\n\n"
      "| γ | τ, kPa | p', kPa | σ'_y, kPa | (σ'_1 − σ'_3)/2p' | σ'_1 from vertical, ° | dε_1 from vertical, ° |\n"
      "|---|---|---|---|---|---|---|\n",
      consolidation, grains, degrees, shear.rve.void_ratio(), shear.lateral() / shear.vertical());
  for (const double gamma : {0.0, 1e-5, 1e-4, 1e-3, 1e-2, 0.05, 0.2})
    {
      shear.to(gamma);
      fmt::print("| {:g} | {:.2f} | {:.1f} | {:.1f} | {:.3f} | {:.1f} | 45 |\n", gamma, shear.shear() / 1e3,
                 shear.mean() / 1e3, shear.vertical() / 1e3, deviator_ratio(shear), tilt(shear));
      std::fflush(stdout);
    }
}

/// tau and p' at each strain (kPa), and V_s (m/s) before shearing.
using Row = std::array<double, 7>;
constexpr std::array<double, 3> strains{1e-3, 1e-2, 0.05};

Row shear_with(Snapshot specimen, double twisting)
{
  LinearRolling law = specimen.law.as<LinearRolling>();
  law.twisting_stiffness = twisting;
  law.twisting = twisting > 0;
  test::Unobserved nobody;
  SpecimenSpec spec;
  spec.domain = "periodic-cell";
  SimpleShear shear(rebalance(specimen, law, {spec, nobody}));
  free_of_shear(shear.rve, false);
  Row row{};
  const Mat6 c = shear.rve.stiffness();
  row[6] = std::sqrt((c(3, 3) + c(4, 4) + c(5, 5)) / 3 / shear.rve.dry_density());
  for (std::size_t k = 0; k < strains.size(); ++k)
    {
      shear.to(strains[k]);
      row[k] = shear.shear() / 1e3;
      row[3 + k] = shear.mean() / 1e3;
    }
  return row;
}

void print_row(double twisting, const std::vector<Row> &rows)
{
  fmt::print("| {:g} |", twisting);
  for (std::size_t k = 0; k < std::tuple_size_v<Row>; ++k)
    {
      double sum = 0, squares = 0;
      for (const Row &row : rows)
        sum += row[k];
      const double mean = sum / static_cast<double>(rows.size());
      for (const Row &row : rows)
        squares += (row[k] - mean) * (row[k] - mean);
      const double spread = rows.size() > 1 ? std::sqrt(squares / static_cast<double>(rows.size() - 1)) : 0.0;
      fmt::print(" {:.1f} ± {:.1f} |", mean, spread);
    }
  fmt::print("\n");
  std::fflush(stdout);
}

void print_twisting(std::uint64_t grains, double degrees, std::uint64_t realisations)
{
  std::vector<Snapshot> specimens;
  for (std::uint64_t seed = 1; seed <= realisations; ++seed)
    {
      test::CellRecipe recipe{.grading = test::small_grading(grains), .degrees = degrees};
      recipe.grading.seed = seed;
      specimens.push_back(test::prepare_in_cell(recipe));
    }
  fmt::print("\n{} grains prepared at {:g}°, {} realisations: mean ± standard deviation\n\n"
             "| α_t | τ at 0.1 %, kPa | τ at 1 % | τ at 5 % | p' at 0.1 %, kPa | p' at 1 % | p' at 5 % | V_s, m/s |\n"
             "|---|---|---|---|---|---|---|---|\n",
             grains, degrees, realisations);
  for (const double twisting : {0.0, 0.1, 0.3, 1.0, 2.0})
    {
      std::vector<Row> rows;
      for (const Snapshot &specimen : specimens)
        rows.push_back(shear_with(specimen, twisting));
      print_row(twisting, rows);
    }
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Tables of docs/results/rve.md: rotation of principal stresses, sensitivity to the twisting stiffness");
  std::uint64_t grains = 1000, realisations = 3;
  double degrees = 7;
  std::string table;
  line.add_option("table", table, "rotation or twisting")->required()->check(CLI::IsMember({"rotation", "twisting"}));
  line.add_option("--grains", grains, "grains of a packing")->check(CLI::Range(200, 20000));
  line.add_option("--degrees", degrees, "preparation friction")->check(CLI::Range(0.1, 60.0));
  line.add_option("--realisations", realisations, "packings of the twisting table")->check(CLI::Range(1, 100));
  return run_command(line, argc, argv, [&] {
    const Stopwatch watch;
    if (table == "twisting")
      print_twisting(grains, degrees, realisations);
    else
      for (const char *consolidation : {"isotropic", "k0"})
        try
          {
            print_rotation(grains, degrees, consolidation);
          }
        catch (const RunFailure &failure)
          {
            fmt::print("\nStopped: {}\n", failure.what());
          }
    fmt::print("\n{:.0f} s on one core\n", watch.seconds());
  });
}
