// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/umat.hpp"

#include "base/error.hpp"
#include "fem/material/wave_moduli.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <mutex>

namespace isostat
{
namespace
{
using UmatFunction = void(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                          double *rpl, double *ddsddt, double *drplde, double *drpldt, const double *stran,
                          const double *dstran, const double *time, const double *dtime, const double *temp,
                          const double *dtemp, const double *predef, const double *dpred, const char *cmname,
                          const int *ndi, const int *nshr, const int *ntens, const int *nstatv, const double *props,
                          const int *nprops, const double *coords, const double *drot, double *pnewdt,
                          const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
                          const int *npt, const int *layer, const int *kspt, const int *kstep, const int *kinc,
                          std::size_t length_of_cmname);

constexpr std::size_t name_length = 80;
constexpr std::array<std::size_t, 6> order = {0, 1, 2, 5, 4, 3}; ///< xx, yy, zz, yz, xz, xy in UMAT's; and back
constexpr double rise = 1.25;                                    ///< of p' at which wave moduli are found again

Stress in_order(const double *six)
{
  Stress other;
  for (std::size_t c = 0; c < 6; ++c)
    other[c] = six[order[c]];
  return other;
}

double mean_pressure(const double *stress) { return -(stress[0] + stress[1] + stress[2]) / 3; }

bool finite(std::span<const double> numbers)
{
  return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

UmatFunction *loaded(const std::string &library)
{
  // dlopen() would look for a bare name in the folders of the system
  const std::string path = std::filesystem::absolute(library).string();
  int mode = RTLD_NOW | RTLD_LOCAL;
#ifndef __SANITIZE_ADDRESS__ // which cannot
  mode |= RTLD_DEEPBIND;     // its own subroutines, not those of the same name in PETSc, MUMPS or LAPACK
#endif
  void *handle = dlopen(path.c_str(), mode);
  if (!handle)
    throw InputError(
        fmt::format("cannot be loaded: {}. Compile it for this machine as a shared library (gfortran -shared "
                    "-fPIC -o my_umat.so my_umat.f90), with all subroutines that it calls.",
                    dlerror()));
  void *found = dlsym(handle, "umat_");
  if (!found)
    throw InputError(
        fmt::format("has no symbol umat_ ({}). Name the subroutine UMAT in Fortran, outside of any module, "
                    "or umat_ in C (extern \"C\" in C++).",
                    path));
  return reinterpret_cast<UmatFunction *>(found);
}

Stiffness stiffness_of(std::span<const double, 36> ddsdde)
{
  Stiffness c;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      c(static_cast<int>(i), static_cast<int>(j)) = ddsdde[order[i] + 6 * order[j]];
  return c;
}

std::string in_capitals(const std::string &name)
{
  std::string text = name.empty() ? "UMAT" : name;
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::toupper(letter); });
  text.resize(name_length, ' ');
  return text;
}
} // namespace

void load_umat(const std::string &library) { loaded(library); }

Umat::Umat(const UmatParameters &law, const std::string &name, std::vector<UmatPoint> points)
    : RowMaterial("umat", law.props, points.size(),
                  first_statev + std::max<std::size_t>(law.nstatv, law.statev.size())),
      law_(law), name_(in_capitals(name)), points_(std::move(points)),
      stride_(first_statev + std::max<std::size_t>(law.nstatv, law.statev.size())), tangents_(points_.size())
{
  try
    {
      function_ = reinterpret_cast<void (*)()>(loaded(law.library));
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("umat.library = \"{}\"; {}", law.library, error.what()));
    }
}

std::string Umat::at(std::size_t point) const
{
  const std::string &name = points_[point].name;
  return at_point(point) + (name.empty() ? "" : name + ": ");
}

/// UMAT from the state in `row` to the one after DSTRAN.   @return PNEWDT
double Umat::call(std::size_t point, double *row, const Stress &dstran, Tangent &ddsdde) const
{
  static std::mutex one_at_a_time;
  const std::lock_guard turn(one_at_a_time);
  const double times[2] = {row[time], row[time]}, none[6] = {}, unity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int three = 3, six = 6, one = 1, kstep[4] = {1, 0, 0, 0}, nstatv = static_cast<int>(stride_ - first_statev),
            nprops = static_cast<int>(law_.props.size()), increment = static_cast<int>(row[kinc]) + 1;
  double heat[4] = {}, ddsddt[6] = {}, drplde[6] = {}, no_statev = 0, pnewdt = 1;
  ddsdde.fill(0);
  reinterpret_cast<UmatFunction *>(function_)(
      row, nstatv > 0 ? row + first_statev : &no_statev, ddsdde.data(), row + energies, row + energies + 1,
      row + energies + 2, heat, ddsddt, drplde, heat + 1, row + stran, dstran.data(), times, &dtime_, none, none, none,
      none, name_.data(), &three, &three, &six, &nstatv, nprops > 0 ? law_.props.data() : none, &nprops,
      points_[point].coords.data(), unity, &pnewdt, none, unity, unity, &points_[point].number, &one, &one, &one, kstep,
      &increment, name_length);
  for (std::size_t c = 0; c < 6; ++c)
    row[stran + c] += dstran[c];
  row[kinc] = increment;
  return pnewdt;
}

void Umat::set_initial_stress(std::span<const Stress> effective)
{
  assert(effective.size() == n_points());
  std::vector<double> rows(committed_.size(), 0.0);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      double *row = &rows[i * stride_];
      const Stress given = in_order(effective[i].data());
      std::ranges::copy(given, row);
      std::ranges::copy(law_.statev, row + first_statev);
      Tangent ddsdde;
      const double pnewdt = call(i, row, {}, ddsdde);
      if (!(pnewdt >= 1))
        throw InputError(fmt::format("{}UMAT rejects the stress in situ (PNEWDT = {:g})", at(i), pnewdt));
      double size = 0, moved = 0;
      for (std::size_t c = 0; c < 6; ++c)
        {
          size = std::max(size, std::abs(given[c]));
          moved = std::max(moved, std::isfinite(row[c]) ? std::abs(row[c] - given[c]) : INFINITY);
        }
      constexpr double most = 0.01;
      if (!(moved <= most * size))
        throw InputError(fmt::format(
            "{}without strain UMAT {}; it got {} PROPS and {} STATEV (NSTATV = {})", at(i),
            std::isfinite(moved) ? fmt::format("moves the stress in situ by {:.4g} Pa, more than 1 % of it", moved)
                                 : "makes the stress in situ no number",
            law_.props.size(), law_.statev.size(), stride_ - first_statev));
      find_waves(i, row, ddsdde);
    }
  committed_ = std::move(rows);
  has_trial_ = false;
}

void Umat::find_waves(std::size_t point, double *row, const Tangent &ddsdde) const
{
  // the symmetric part: no wave is faster than its fastest, whichever triangle of DDSDDE has the larger entries
  const Stiffness c = stiffness_of(ddsdde), symmetric = (c + c.transpose()) / 2;
  const WaveModuli moduli = finite(ddsdde) ? max_wave_moduli(symmetric) : WaveModuli{};
  if (!(moduli.p > 0))
    throw InputError(
        fmt::format("{}no wave runs with DDSDDE of a call without strain; it must be finite, with a P-wave "
                    "modulus above 0. Let UMAT fill it in every call",
                    at(point)));
  row[waves] = std::max(row[waves], moduli.p);
  row[waves + 1] = std::max(row[waves + 1], moduli.s);
  row[pressure] = std::max(mean_pressure(row), 1e-6 * moduli.p); // above 0, so that it rises a few times at most
}

void Umat::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points() && stresses.size() == n_points());
  has_trial_ = false;
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Stress dstran = in_order(strain(increments[i]).data());
      if (!finite(dstran))
        throw RunFailure(at(i) + "the strain is not a number");
      const auto from = committed_.begin() + static_cast<std::ptrdiff_t>(i * stride_);
      double *row = &trial_[i * stride_];
      std::copy_n(from, stride_, row);
      const double pnewdt = call(i, row, dstran, tangents_[i]);
      row[time] += dtime_;
      if (!(pnewdt >= 1))
        throw RunFailure(fmt::format("{}UMAT asks for a smaller increment (PNEWDT = {:g})", at(i), pnewdt));
      if (!finite({row, 6}))
        throw RunFailure(at(i) + "UMAT gives a stress that is not a number; take smaller steps");
      stresses[i] = in_order(row);
    }
  has_trial_ = true;
}

void Umat::commit()
{
  if (!has_trial_)
    return;
  RowMaterial::commit();
  for (std::size_t i = 0; i < n_points(); ++i)
    if (double *row = &committed_[i * stride_]; mean_pressure(row) > rise * row[pressure])
      try
        {
          find_waves(i, row, still_tangent(i));
        }
      catch (const InputError &error) // in a run: it says the step
        {
          throw RunFailure(error.what());
        }
}

/// DDSDDE of the committed state.
Umat::Tangent Umat::still_tangent(std::size_t point) const
{
  const auto first = committed_.begin() + static_cast<std::ptrdiff_t>(point * stride_);
  std::vector<double> row(first, first + static_cast<std::ptrdiff_t>(stride_));
  Tangent ddsdde;
  call(point, row.data(), {}, ddsdde);
  return ddsdde;
}

void Umat::stiffness(std::span<Stiffness> tangents) const
{
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Tangent ddsdde = has_trial_ ? tangents_[i] : still_tangent(i);
      if (!finite(ddsdde))
        throw RunFailure(at(i) + "UMAT gives a DDSDDE that is not finite");
      tangents[i] = stiffness_of(ddsdde);
    }
}

void Umat::wave_moduli(std::span<WaveModuli> moduli) const
{
  for (std::size_t i = 0; i < n_points(); ++i)
    moduli[i] = {committed_[i * stride_ + waves], committed_[i * stride_ + waves + 1]};
}

std::span<const double> Umat::statev(std::size_t point) const
{
  return std::span(committed_).subspan(point * stride_ + first_statev, stride_ - first_statev);
}
} // namespace isostat
