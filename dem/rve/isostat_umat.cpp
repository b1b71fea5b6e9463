// SPDX-License-Identifier: BSD-3-Clause
// libisostat_umat.so: a packing as the user subroutine UMAT of Abaqus, for any program that has this door (Isostat's
// own columns: material "umat").
//
//     STATEV    the whole packing: [1] bytes of it, 0 before the first call, [2..37] DDSDDE, then the bytes. The
//               message of an NSTATV that is too small says what it takes (250 grains: 12,000). Nothing else is kept
//               between calls, so that hosts may repeat, reject and restart increments as they like, in any thread
//     CMNAME    LOOSE: the specimen loose.h5 (small letters) in the working directory, or in the folder that the
//               environment variable ISOSTAT_UMAT_FOLDER names
//     PROPS     all optional. [1] n > 0: the entry s000n of a library of specimens; [2] inertial number of the
//               increments, 0: 1e-4; [3] 1: DDSDDE of the present state in every call
//     STRESS    of the first call: the packing is brought to it, within 1e-3 of p'; all 0: it stays as prepared. Later
//               ones are not read
//     DDSDDE    stiffness of the state in which every contact is elastic (isostat_rve_stiffness()), of calls with
//               DSTRAN = 0; others give that of the last such call unless PROPS(3) = 1
//
// Small strain: the displacement gradient is the symmetric DSTRAN. Pa, tension positive. Failures are on stderr, and
// PNEWDT becomes 0.5.   tested: tests/python/umat_test.py
#include "base/error.hpp"
#include "dem/rve/isostat_rve.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <span>

namespace isostat
{
namespace
{
constexpr std::size_t order[] = {0, 1, 2, 5, 4, 3}; // 11, 22, 33, 12, 13, 23 in xx, yy, zz, yz, xz, xy; and back
constexpr std::size_t tangent = 1, bytes = 37;      // places in STATEV

void must(isostat_status status)
{
  if (status != ISOSTAT_OK)
    throw RunFailure(isostat_rve_error());
}

/// A call of UMAT, as far as a packing minds it.
struct Call
{
  double *stress, *ddsdde;
  std::span<double> statev;
  const double *dstran;
  std::span<const double> props;
  std::string name; ///< of the material, small letters

  double prop(std::size_t k) const { return k < props.size() ? props[k] : 0; }
  bool still() const
  {
    return std::all_of(dstran, dstran + 6, [](double x) { return x == 0; });
  }
};

using Element = std::unique_ptr<isostat_rve, decltype(&isostat_rve_destroy)>;

isostat_rve_settings settings_of(const Call &call)
{
  isostat_rve_settings settings;
  isostat_rve_default_settings(&settings);
  if (call.prop(1) != 0)
    settings.inertial_number = call.prop(1);
  return settings;
}

/// That of the first call, at its stress.
Element begun(const Call &call, const isostat_rve_settings &settings)
{
  const char *folder = std::getenv("ISOSTAT_UMAT_FOLDER");
  std::string path = fmt::format("{}{}{}.h5", folder ? folder : "", folder ? "/" : "", call.name);
  if (call.prop(0) > 0)
    path += fmt::format("#s{:04}", static_cast<int>(call.prop(0)));
  isostat_rve *made = nullptr;
  must(isostat_rve_create(path.c_str(), &settings, &made));
  Element rve(made, isostat_rve_destroy);
  double target[6];
  for (std::size_t c = 0; c < 6; ++c)
    target[c] = call.stress[order[c]];
  if (std::any_of(target, target + 6, [](double s) { return s != 0; }))
    {
      constexpr double none[9] = {}, tolerance = 1e-3;
      constexpr int all[6] = {1, 1, 1, 1, 1, 1};
      must(isostat_rve_mixed(made, none, target, all, tolerance, nullptr));
    }
  return rve;
}

Element kept(const Call &call, const isostat_rve_settings &settings)
{
  isostat_rve *made = nullptr;
  must(isostat_rve_unpack(call.statev.data() + bytes, static_cast<std::size_t>(call.statev[0]), &settings, &made));
  return {made, isostat_rve_destroy};
}

void keep(const Call &call, const isostat_rve *rve)
{
  std::size_t size = 0;
  must(isostat_rve_pack(rve, nullptr, &size));
  if (const std::size_t needed = bytes + (size + sizeof(double) - 1) / sizeof(double); needed > call.statev.size())
    throw RunFailure(
        fmt::format("NSTATV = {}; must be at least {}, and a fifth more because contacts become more. Give "
                    "for example {}.",
                    call.statev.size(), needed, needed + needed / 5));
  must(isostat_rve_pack(rve, call.statev.data() + bytes, &size));
  call.statev[0] = static_cast<double>(size);
}

void run(const Call &call)
{
  const isostat_rve_settings settings = settings_of(call);
  if (call.statev.size() <= bytes)
    throw RunFailure(fmt::format("NSTATV = {}; must hold the packing. Give for example 14000.", call.statev.size()));
  const bool first = call.statev[0] == 0;
  const Element rve = first ? begun(call, settings) : kept(call, settings);
  if (!call.still())
    {
      const double *e = call.dstran;
      const double gradient[9] = {e[0], e[3] / 2, e[4] / 2, e[3] / 2, e[1], e[5] / 2, e[4] / 2, e[5] / 2, e[2]};
      must(isostat_rve_advance(rve.get(), gradient, nullptr));
    }
  if (first || call.still() || call.prop(2) != 0)
    {
      double c[36];
      must(isostat_rve_stiffness(rve.get(), 1, c));
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
          call.statev[tangent + i + 6 * j] = c[6 * order[i] + order[j]];
    }
  keep(call, rve.get());
  double stress[6];
  must(isostat_rve_stress(rve.get(), stress));
  for (std::size_t i = 0; i < 6; ++i)
    call.stress[i] = stress[order[i]];
  std::copy_n(call.statev.data() + tangent, 36, call.ddsdde);
}
} // namespace
} // namespace isostat

extern "C" __attribute__((visibility("default"))) void
umat_(double *stress, double *statev, double *ddsdde, double *, double *, double *, double *, double *, double *,
      double *, const double *, const double *dstran, const double *, const double *, const double *, const double *,
      const double *, const double *, const char *cmname, const int *, const int *, const int *ntens, const int *nstatv,
      const double *props, const int *nprops, const double *, const double *, double *pnewdt, const double *,
      const double *, const double *, const int *noel, const int *npt, const int *, const int *, const int *,
      const int *)
{
  constexpr std::size_t longest = 80;
  std::string name(cmname, longest);
  name.erase(name.find_last_not_of(' ') + 1);
  try
    {
      if (*ntens != 6)
        throw isostat::RunFailure(fmt::format("NTENS = {}; must be 6 because packings are three-dimensional. Give "
                                              "elements in space.",
                                              *ntens));
      std::string file = name;
      std::transform(file.begin(), file.end(), file.begin(), [](unsigned char c) { return std::tolower(c); });
      isostat::run({stress,
                    ddsdde,
                    {statev, static_cast<std::size_t>(*nstatv)},
                    dstran,
                    {props, static_cast<std::size_t>(*nprops)},
                    file});
    }
  catch (const std::exception &error)
    {
      fmt::print(stderr, "isostat_umat: material {}, element {}, point {}: {}\n", name, *noel, *npt, error.what());
      *pnewdt = 0.5;
    }
}
