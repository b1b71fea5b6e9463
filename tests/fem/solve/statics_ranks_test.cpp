// SPDX-License-Identifier: BSD-3-Clause
// A mesh shared out over the ranks of a run gives what each rank finds alone, and iterative solvers what the direct one
// finds, on one rank and, run with mpirun, on several.
#include "base/error.hpp"
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/cryers_sphere.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
template <int dim>
struct Footing
{
  static MeshSpec mesh()
  {
    MeshSpec mesh;
    mesh.soil.layers = {{.name = "clay", .thickness = 2, .permeability = 1e-8, .cells = 3}};
    mesh.width = {3, 2};
    mesh.cells_across = {dim == 2 ? 8u : 4u, 2};
    return mesh;
  }
  static Supports supports(bool tied)
  {
    Supports supports{
        .tied_sides = tied, .fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}}, .drained = {Face::surface}};
    if (!tied)
      supports.fixed.insert(supports.fixed.end(), {{Face::x_low, 0}, {Face::x_high, 0}});
    return supports;
  }
  static StaticsSettings settings(bool pore_water, const std::string &petsc)
  {
    StaticsSettings settings;
    settings.pore_water = pore_water;
    settings.petsc = petsc;
    settings.tractions = {{Face::surface, [](double, const Place &at) {
                             return Place{0, 0, at[0] > 0.7 && at[0] < 1.6 ? -1e4 : 0.0};
                           }}};
    return settings;
  }
  /// Of a mesh that is given, whose unit square gets the sizes of that one.
  static MeshSpec distorted()
  {
    const auto drawn = [](std::array<double, 3> at) {
      const std::array<double, 3> pushed = test::PushedAbout<2>{6}(at);
      return std::array<double, 3>{3 * pushed[0], 2 * pushed[1], 0};
    };
    MeshSpec mesh = test::soil_of(test::read_gmsh_text(test::gmsh_text<2>({6, 6, 0}, drawn), 2));
    mesh.soil.layers[0].permeability = 1e-8;
    return mesh;
  }
  explicit Footing(MPI_Comm communicator, bool tied, bool pore_water = true, const std::string &petsc = {},
                   const MeshSpec &of = mesh())
      : space(of, supports(tied), communicator), soil({5e7, 0.2}, space.n_points()),
        statics(space, soil, settings(pore_water, petsc))
  {
    if (pore_water)
      statics.step_undrained();
    for (int k = 0; k < 5; ++k)
      statics.step(50);
  }
  /// Displacements and pressures at some places, and the reaction of the base.
  std::vector<double> answers() const
  {
    std::vector<double> values;
    for (const Place &place : {Place{0.75, 0, 2}, Place{1.5, 1, 1}, Place{2.25, 2, 2.0 / 3}})
      {
        for (unsigned c = 0; c < 3; ++c)
          values.push_back(value(statics.displacement(), space.find_dof(place, c)));
        values.push_back(value(statics.pressure(), space.find_pressure(place)));
      }
    values.push_back(statics.reaction({Face::base, 2}));
    return values;
  }
  double value(const Vector &vector, long unknown) const
  {
    double value = unknown < 0 ? 0 : vector.local_element(unknown);
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, space.communicator());
    return value;
  }

  Discretisation<dim> space;
  Elastic soil;
  Statics statics;
};

/// Largest difference of answers, relative to the largest of their kind.
double difference(const std::vector<double> &alone, const std::vector<double> &shared)
{
  double largest[3] = {0, 0, 0}, error = 0; // of displacements, pressures, reaction
  const auto kind = [&](std::size_t k) { return k + 1 == alone.size() ? 2 : k % 4 == 3 ? 1 : 0; };
  for (std::size_t k = 0; k < alone.size(); ++k)
    largest[kind(k)] = std::max(largest[kind(k)], std::abs(alone[k]));
  for (std::size_t k = 0; k < alone.size(); ++k)
    if (largest[kind(k)] > 0)
      error = std::max(error, std::abs(shared[k] - alone[k]) / largest[kind(k)]);
  return error;
}

template <int dim>
void compare(bool tied, const MeshSpec &mesh = Footing<dim>::mesh())
{
  const std::vector<double> alone = Footing<dim>(MPI_COMM_SELF, tied, true, {}, mesh).answers(),
                            shared = Footing<dim>(MPI_COMM_WORLD, tied, true, {}, mesh).answers();
  EXPECT_BELOW_BECAUSE(difference(alone, shared), 1e-10,
                       "tolerance of the solution, and round-off of sums over the ranks");
  EXPECT_GT(std::abs(alone[7]), 10); // a pressure below the surface
}

/// Options of PETSc against LU.   @param most  iterations of a solution, below
template <int dim>
void compare(bool pore_water, const std::string &petsc, unsigned most = 60)
{
  const std::vector<double> direct = Footing<dim>(MPI_COMM_SELF, false, pore_water).answers();
  const Footing<dim> footing(MPI_COMM_WORLD, false, pore_water, petsc);
  const LinearEffort effort = footing.statics.linear_effort();
  EXPECT_BELOW_BECAUSE(difference(direct, footing.answers()), 1e-7, "Newton's tolerance 1e-8, and the solver's 1e-10")
      << petsc;
  EXPECT_GT(effort.solves, 0u);
  EXPECT_LT(effort.most, most) << effort.method;
}
} // namespace

TEST(StaticsRanks, SharedOutIsTheSame)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1)
    GTEST_SKIP() << "the test mpi_statics runs it with mpirun";
  compare<2>(false);
  compare<2>(true);
  compare<3>(false);
  compare<2>(false, Footing<2>::distorted());
  compare<2>(true, Footing<2>::distorted());
  MeshSpec refined = Footing<2>::mesh();
  refined.refine = {{{0.4, 0, 0.6}, {2, 0, 2}, 2}};
  compare<2>(false, refined);
  refined.refine.push_back({{-1, 0, 0}, {9, 0, 2}, 1}); // alike at both sides
  compare<2>(true, refined);
  refined = Footing<3>::mesh();
  refined.refine = {{{0.8, 0, 0.6}, {2.2, 2, 1.4}, 1}};
  compare<3>(false, refined);
}

TEST(StaticsRanks, IterativeSolversFindTheSame)
{
  for (const char *multigrid : {"hypre", "gamg"})
    {
      const std::string options = fmt::format("-statics_ksp_type cg -statics_pc_type {} -water_ignored 1", multigrid);
      compare<2>(false, options);
      compare<3>(false, options);
    }
  compare<2>(true,
             "-statics_pc_type fieldsplit -statics_pc_fieldsplit_type schur -statics_pc_fieldsplit_schur_fact_type "
             "full -statics_pc_fieldsplit_schur_precondition selfp -statics_fieldsplit_u_pc_type redundant "
             "-statics_fieldsplit_p_pc_type redundant -statics_fieldsplit_u_ksp_type preonly "
             "-statics_fieldsplit_p_ksp_type gmres -statics_fieldsplit_p_ksp_rtol 1e-3");
  compare<3>(true, "-statics_pc_type fieldsplit -statics_ksp_converged_reason ascii:/dev/null", 30);
}

/// (16a): what a solution needs depends neither on the mesh nor on the time step.
TEST(StaticsRanks, IterationsOfASplitDoNotGrow)
{
  const auto solved = [](unsigned n, double step, const std::string &petsc) {
    test::CryersSphere sphere(n, petsc, MPI_COMM_WORLD, std::numeric_limits<double>::infinity());
    sphere.statics.step_undrained();
    for (int k = 0; k < 2; ++k)
      sphere.statics.step(step * sphere.seconds);
    return std::pair{sphere.pressure(), sphere.statics.linear_effort().most};
  };
  for (const double step : {1e-4, 1e-1})
    {
      const std::string split = "-statics_pc_type fieldsplit";
      const auto [coarse, of_coarse] = solved(2, step, split);
      const auto [direct, none] = solved(2, step, {});
      EXPECT_NEAR_BECAUSE(coarse, direct, 1e-8, "Newton's tolerance 1e-10");
      EXPECT_EQ(none, 0u);
      const auto [fine, of_fine] = solved(4, step, split);
      EXPECT_LT(of_fine, 32u);
      EXPECT_LE(of_fine, of_coarse + 5);
    }
}

TEST(StaticsRanks, OptionsThatCannotBe)
{
  const auto refused = [](const char *options) {
    try
      {
        Footing<2>(MPI_COMM_WORLD, false, false, options);
      }
    catch (const InputError &error)
      {
        return std::string(error.what());
      }
    return std::string();
  };
  EXPECT_THAT(refused("-statics_ksp_type cg -statics_pc_gamg_typo 3"),
              testing::HasSubstr("-statics_pc_gamg_typo has no effect"));
  EXPECT_THAT(refused("-statics_pc_type jacobi -statics_ksp_type kg"),
              testing::HasSubstr("refuses -statics_ksp_type kg: "));
  EXPECT_THAT(refused("-statics_ksp_type cg -statics_ksp_rtol small"),
              testing::HasSubstr("refuses -statics_ksp_rtol small: "));
  try
    {
      Footing<2>(MPI_COMM_WORLD, false, false, "-statics_ksp_type cg -statics_pc_type jacobi -statics_ksp_max_it 2");
      FAIL();
    }
  catch (const RunFailure &failure)
    {
      EXPECT_THAT(failure.what(), testing::HasSubstr("DIVERGED_ITS after 2 iterations"));
    }
}
} // namespace isostat
