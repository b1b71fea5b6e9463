// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ.hpp"

#include "base/error.hpp"
#include "base/files/hash.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double density_reach = 0.05;
constexpr std::size_t lines_in_message = 40;
constexpr std::uint64_t recipe_version = 1;
constexpr int most_waits = 50;
constexpr double loose_tolerance = 1e-2; ///< on the way

std::uint64_t hash_of(const Snapshot &s)
{
  Hash hash;
  const auto add = [&](std::span<const double> numbers) { hash.words(numbers); };
  if (!is_default(s.law))
    for (const char *c = s.law->name(); *c; ++c)
      add(std::array{double(*c)});
  add(parameter_values(s.law));
  add(std::array{s.grains.density, s.time, double(s.step)});
  const std::size_t n = 4 * s.grains.n_grains();
  for (const auto *records : {&s.grains.position, &s.grains.velocity, &s.grains.spin})
    add(std::span(records->data(), n));
  if (s.cell)
    {
      for (const Mat3 *m : {&s.cell->edges, &s.cell->deformation, &s.cell->rotation})
        add({m->data(), 9});
      add(std::array{s.cell->reference_volume, s.cell->volume_strain});
    }
  for (const Contact &c : s.contacts)
    {
      add(std::array{double(c.first), double(c.second), c.overlap});
      for (const HistoryVector &v : history_vectors)
        add({(c.history.*v.place).data(), 3});
      add(c.history.own);
    }
  return hash.value();
}

double pressure(const Mat3 &stress) { return -stress.trace() / 3; }

std::string in_words(const Mat3 &s)
{
  return fmt::format("sigma'_v = {:.4g} kPa, sigma'_h = {:.4g} and {:.4g} kPa", -s(1, 1) / 1e3, -s(0, 0) / 1e3,
                     -s(2, 2) / 1e3);
}

/// Part w of the way: normal stresses geometrically, shear stresses linearly.
Mat3 on_the_way(const Mat3 &from, const Mat3 &to, double w)
{
  Mat3 stress = (1 - w) * from + w * to;
  for (int k = 0; k < 3; ++k)
    stress(k, k) = -std::exp((1 - w) * std::log(-from(k, k)) + w * std::log(-to(k, k)));
  return stress;
}

void go(Rve &rve, const MixedIncrement &step, const Mat3 &from, const Mat3 &wanted)
{
  const RveResponse response = rve.advance(step);
  if (response.outcome != RveOutcome::accepted)
    throw RunFailure(fmt::format(
        "{}: not reached from a specimen at {}; it came to {} ({}). K0 may be beyond what the packing can carry, or "
        "the stress too far from the library's: add specimens at a nearer stress with specimen_library.",
        in_words(wanted), in_words(from), in_words(response.stress), response.reason));
}

/// Change of stress over p' in 2,000 time steps without strain.
double moved_while_waiting(Rve &rve)
{
  const Mat3 before = rve.stress();
  for (int k = 0; k < 50; ++k)
    rve.advance(MixedIncrement{}); // 40 steps until it has looked three times that nothing is wanted
  return (rve.stress() - before).cwiseAbs().maxCoeff() / pressure(before);
}

void check_wanted(const Mat3 &wanted, const InSituSettings &settings)
{
  if (!wanted.allFinite() || !(wanted.diagonal().maxCoeff() < 0))
    throw InputError(fmt::format("{}: soil in situ is compressed in all directions. Give layers a weight above the "
                                 "water's, or a surcharge, and K0 above 0.",
                                 in_words(wanted)));
  if (pressure(wanted) < settings.min_pressure)
    throw InputError(fmt::format("{}: p' = {:.4g} kPa is below {:.4g} kPa, too little for a packing to carry. Give a "
                                 "surcharge, or a coarser uppermost element.",
                                 in_words(wanted), pressure(wanted) / 1e3, settings.min_pressure / 1e3));
}
} // namespace

Mat3 column_frame()
{
  Mat3 frame;
  frame << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return frame;
}

Mat3 to_matrix(const Gradient &h)
{
  Mat3 m;
  m << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  return m;
}

Mat3 to_matrix(const Stress &s)
{
  Mat3 m;
  m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return m;
}

Stress to_stress(const Mat3 &m) { return {m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1)}; }

const LibraryEntry &nearest_entry(const std::vector<LibraryEntry> &entries, const SpecimenRequest &request,
                                  double vertical, double horizontal)
{
  const bool any = !request.relative_density;
  const auto offset = [&](const LibraryEntry &e) {
    return any ? 0.0 : std::abs(e.number("relative_density") - *request.relative_density);
  };
  std::vector<const LibraryEntry *> fits;
  std::vector<double> seeds;
  for (const LibraryEntry &e : entries)
    if (offset(e) <= density_reach && e.number("vertical_stress_Pa") > 0 && e.number("K0") > 0 && e.number("seed") >= 0)
      {
        fits.push_back(&e);
        seeds.push_back(e.number("seed"));
      }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  if (request.realisation >= seeds.size())
    throw InputError(fmt::format(
        "the library has {} realisations {}, the soil needs {}. Add some with specimen_library --append. It has:\n{}",
        seeds.size(), any ? "" : fmt::format("of D_r within {:g} of {:g}", density_reach, *request.relative_density),
        request.realisation + 1, library_table(entries, lines_in_message)));
  const auto distance = [&](const LibraryEntry *e) {
    const double v = e->number("vertical_stress_Pa"), h = v * e->number("K0");
    return 100 * std::round(100 * offset(*e)) + std::abs(std::log(v / vertical)) + std::abs(std::log(h / horizontal));
  };
  std::erase_if(fits, [&](const LibraryEntry *e) { return e->number("seed") != seeds[request.realisation]; });
  return **std::min_element(fits.begin(), fits.end(), [&](auto *a, auto *b) { return distance(a) < distance(b); });
}

std::vector<std::byte> bring_to_stress(const Snapshot &specimen, const Mat3 &wanted, const MotionSpec &motion,
                                       const InSituSettings &settings)
{
  check_wanted(wanted, settings);
  RveSettings own;
  own.motion = motion;
  own.max_steps = settings.max_steps;
  Rve rve(specimen, own);
  const Mat3 from = rve.stress();
  if (!(from.diagonal().maxCoeff() < 0))
    throw RunFailure("the specimen carries no stress in one direction; prepare it at a higher pressure");
  MixedIncrement step;
  const bool sides_fixed = settings.path == InSituPath::no_lateral_strain;
  step.controlled.setConstant(!sides_fixed);
  step.controlled(1, 1) = true;
  const Eigen::Array3d ratio = wanted.diagonal().array() / from.diagonal().array();
  const int steps = 1 + static_cast<int>(ratio.log().abs().maxCoeff() / std::log(2.0));
  for (int k = 1; k <= steps; ++k)
    {
      step.stress = on_the_way(from, wanted, double(k) / steps);
      step.tolerance = k < steps ? loose_tolerance : settings.tolerance;
      go(rve, step, from, wanted);
    }
  for (int k = 0; moved_while_waiting(rve) > 2 * settings.tolerance; ++k)
    {
      if (k == most_waits)
        throw RunFailure(fmt::format("{}: the packing does not come to rest there; K0 may be beyond what it can carry",
                                     in_words(wanted)));
      go(rve, step, from, wanted);
    }
  return rve.pack();
}

Snapshot specimen_of(std::span<const std::byte> packed) { return Rve::unpack(packed, {}).assembly().snapshot(); }

std::string in_situ_recipe(const Snapshot &specimen, const Mat3 &w, const MotionSpec &m, const InSituSettings &s)
{
  const auto optional = [](const std::optional<double> &x) { return x ? fmt::format("{:.17g}", *x) : "no"; };
  return fmt::format("in situ {}; specimen {:016x}; stress {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}; path {}; "
                     "tolerance {:.17g}; steps {}; motion {:.17g} {} {} {:.17g} {:.17g} {:.17g} {:.17g} {}",
                     recipe_version, hash_of(specimen), w(0, 0), w(1, 1), w(2, 2), w(1, 2), w(0, 2), w(0, 1),
                     static_cast<int>(s.path), s.tolerance, s.max_steps, m.damping, optional(m.strain_rate),
                     optional(m.inertial_number), m.quasi_static_tolerance, m.rate_floor, m.rate_ceiling,
                     m.time_step_safety, optional(m.time_step));
}
} // namespace isostat
