// SPDX-License-Identifier: BSD-3-Clause
// The volume element behind a C interface: every call is caught, every failure becomes a status and a message.
#include "dem/rve/isostat_rve.h"

#include "base/error.hpp"
#include "dem/io/stored_packing.hpp"
#include "dem/rve/rve.hpp"
#include "dem/scene/scene.hpp"

#include <cmath>
#include <cstring>
#include <exception>
#include <fmt/format.h>

struct isostat_rve
{
  isostat::Rve element;
};

struct isostat_rve_state
{
  isostat::RveState state;
};

namespace isostat
{
namespace
{
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
constexpr int voigt_row[] = {0, 1, 2, 1, 0, 0}, voigt_column[] = {0, 1, 2, 2, 2, 1};

thread_local char message[4096] = ""; // no memory is asked for where there may be none
isostat_status report(isostat_status status, const char *function, const char *what)
{
  std::snprintf(message, sizeof message, "%s: %s", function, what);
  return status;
}

/// Runs the body of a function of the interface; nothing is thrown through it.
template <typename Body>
isostat_status guarded(const char *function, const Body &body) noexcept
{
  try
    {
      return body();
    }
  catch (const InputError &error)
    {
      return report(ISOSTAT_BAD_INPUT, function, error.what());
    }
  catch (const std::exception &error)
    {
      return report(ISOSTAT_FAILURE, function, error.what());
    }
  catch (...)
    {
      return report(ISOSTAT_FAILURE, function, "unknown failure");
    }
}

/// What a pointer of the caller points to.
template <typename T>
T &given(T *pointer, const char *name)
{
  if (!pointer)
    throw InputError(fmt::format("{} is a null pointer. Give the address of one.", name));
  return *pointer;
}

template <typename T>
T &handle(T *pointer, const char *name)
{
  if (!pointer)
    throw InputError(fmt::format("the handle `{}` is null. Give one that was made and not destroyed.", name));
  return *pointer;
}

Mat3 matrix(const double *numbers, const char *name) { return Eigen::Map<const RowMajor>(&given(numbers, name)); }

void write_voigt(const Mat3 &symmetric, double *numbers)
{
  for (int k = 0; k < 6; ++k)
    numbers[k] = symmetric(voigt_row[k], voigt_column[k]);
}

RveSettings cpp_settings(const isostat_rve_settings *given_settings)
{
  isostat_rve_settings s;
  isostat_rve_default_settings(&s);
  if (given_settings)
    s = *given_settings;
  RveSettings settings;
  settings.motion = controlled_motion();
  settings.motion.inertial_number = s.inertial_number;
  settings.motion.damping = s.damping;
  if (s.strain_rate != 0) // 0: none
    settings.motion.strain_rate = s.strain_rate;
  settings.frame = matrix(s.frame, "frame");
  settings.max_increment = s.max_increment;
  settings.min_steps = s.min_steps;
  settings.max_steps = s.max_steps;
  try
    {
      settings.check();
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("{} isostat_rve_default_settings() gives values to begin with.", error.what()));
    }
  return settings;
}

Snapshot specimen_at(const std::string &place_text)
{
  const SpecimenPlace place = specimen_place(place_text);
  return read_stored_packing(place.path, place.entry).state;
}

isostat_status told(const char *function, const RveResponse &response, isostat_rve_response *out)
{
  if (out)
    {
      write_voigt(response.stress, out->stress);
      out->mean_stress_change = response.mean_stress_change;
      out->indicator = response.indicator;
      out->steps = response.steps;
    }
  return response.outcome == RveOutcome::accepted ? ISOSTAT_OK
                                                  : report(ISOSTAT_REJECTED, function, response.reason.c_str());
}

MixedIncrement mixed_increment(const double *gradient, const double *stress, const int *controlled, double tolerance)
{
  MixedIncrement increment;
  increment.gradient = matrix(gradient, "gradient");
  increment.tolerance = tolerance;
  given(stress, "stress"), given(controlled, "controlled");
  for (int k = 0; k < 6; ++k)
    if (controlled[k])
      {
        const int i = voigt_row[k], j = voigt_column[k];
        increment.stress(i, j) = increment.stress(j, i) = stress[k];
        increment.controlled(i, j) = increment.controlled(j, i) = true;
      }
  return increment;
}
} // namespace
} // namespace isostat

using namespace isostat;

const char *isostat_rve_error(void) { return message; }

void isostat_rve_default_settings(isostat_rve_settings *settings)
{
  if (!settings)
    return;
  const RveSettings own;
  const MotionSpec motion = controlled_motion();
  *settings = {.inertial_number = *motion.inertial_number,
               .strain_rate = 0,
               .damping = motion.damping,
               .frame = {1, 0, 0, 0, 1, 0, 0, 0, 1},
               .max_increment = own.max_increment,
               .min_steps = own.min_steps,
               .max_steps = own.max_steps};
}

isostat_status isostat_rve_create(const char *specimen, const isostat_rve_settings *settings, isostat_rve **rve)
{
  if (rve)
    *rve = nullptr;
  return guarded(__func__, [&] {
    isostat_rve *&place = given(rve, "rve");
    place = new isostat_rve{Rve(specimen_at(&given(specimen, "specimen")), cpp_settings(settings))};
    return ISOSTAT_OK;
  });
}

void isostat_rve_destroy(isostat_rve *rve) { delete rve; }

isostat_status isostat_rve_advance(isostat_rve *rve, const double *gradient, isostat_rve_response *response)
{
  const char *function = __func__;
  return guarded(function, [&] {
    return told(function, handle(rve, "rve").element.advance(matrix(gradient, "gradient")), response);
  });
}

isostat_status isostat_rve_undrained(isostat_rve *rve, const double *gradient, isostat_rve_response *response)
{
  const char *function = __func__;
  return guarded(function, [&] {
    return told(function, handle(rve, "rve").element.undrained(matrix(gradient, "gradient")), response);
  });
}

isostat_status isostat_rve_mixed(isostat_rve *rve, const double *gradient, const double *stress, const int *controlled,
                                 double tolerance, isostat_rve_response *response)
{
  const char *function = __func__;
  return guarded(function, [&] {
    Rve &element = handle(rve, "rve").element;
    return told(function, element.advance(mixed_increment(gradient, stress, controlled, tolerance)), response);
  });
}

isostat_status isostat_rve_stress(const isostat_rve *rve, double *stress)
{
  return guarded(__func__, [&] {
    write_voigt(handle(rve, "rve").element.stress(), &given(stress, "stress"));
    return ISOSTAT_OK;
  });
}

isostat_status isostat_rve_stiffness(const isostat_rve *rve, int yielding_contacts_resist, double *stiffness)
{
  return guarded(__func__, [&] {
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(&given(stiffness, "stiffness")) =
        handle(rve, "rve").element.stiffness(yielding_contacts_resist ? Sliding::elastic : Sliding::plastic);
    return ISOSTAT_OK;
  });
}

isostat_status isostat_rve_void_ratio(const isostat_rve *rve, double *void_ratio)
{
  return guarded(__func__, [&] {
    given(void_ratio, "void_ratio") = handle(rve, "rve").element.void_ratio();
    return ISOSTAT_OK;
  });
}

isostat_status isostat_rve_densities(const isostat_rve *rve, double water, double *dry, double *saturated)
{
  return guarded(__func__, [&] {
    const Rve &element = handle(rve, "rve").element;
    if (!(water >= 0 && std::isfinite(water)))
      throw InputError(fmt::format("water = {:g} kg/m3; it must not be negative. Give its density, 1000.", water));
    if (dry)
      *dry = element.dry_density();
    if (saturated)
      *saturated = element.saturated_density(water);
    return ISOSTAT_OK;
  });
}

isostat_status isostat_rve_steps(const isostat_rve *rve, uint64_t *steps)
{
  return guarded(__func__, [&] {
    given(steps, "steps") = handle(rve, "rve").element.cost().steps;
    return ISOSTAT_OK;
  });
}

isostat_status isostat_rve_save(const isostat_rve *rve, isostat_rve_state **state)
{
  return guarded(__func__, [&] {
    const isostat_rve &from = handle(rve, "rve");
    isostat_rve_state *&to = given(state, "state");
    RveState copy = from.element.save();
    if (to)
      *to = {std::move(copy)};
    else
      to = new isostat_rve_state{std::move(copy)};
    return ISOSTAT_OK;
  });
}

isostat_status isostat_rve_restore(isostat_rve *rve, const isostat_rve_state *state)
{
  return guarded(__func__, [&] {
    isostat_rve &to = handle(rve, "rve");
    const isostat_rve_state &from = handle(state, "state");
    to.element.restore(from.state);
    return ISOSTAT_OK;
  });
}

void isostat_rve_state_destroy(isostat_rve_state *state) { delete state; }

isostat_status isostat_rve_pack(const isostat_rve *rve, void *bytes, size_t *size)
{
  return guarded(__func__, [&] {
    const Rve &element = handle(rve, "rve").element;
    const std::size_t room = given(size, "size");
    const std::vector<std::byte> packed = element.pack();
    *size = packed.size();
    if (bytes && room < packed.size())
      throw InputError(fmt::format("size = {} bytes of room, but the element takes {}. Ask for the size with a null "
                                   "pointer first.",
                                   room, packed.size()));
    if (bytes)
      std::memcpy(bytes, packed.data(), packed.size());
    return ISOSTAT_OK;
  });
}

isostat_status isostat_rve_unpack(const void *bytes, size_t size, const isostat_rve_settings *settings,
                                  isostat_rve **rve)
{
  if (rve)
    *rve = nullptr;
  return guarded(__func__, [&] {
    const std::span packed(&given(static_cast<const std::byte *>(bytes), "bytes"), size);
    isostat_rve *&place = given(rve, "rve");
    place = new isostat_rve{Rve::unpack(packed, cpp_settings(settings))};
    return ISOSTAT_OK;
  });
}
