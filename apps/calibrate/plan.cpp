// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/plan.hpp"

#include "apps/common/command_line.hpp"
#include "base/error.hpp"
#include "base/scene/fragment.hpp"
#include "base/scene/ranges.hpp"
#include "base/scene/reader.hpp"
#include "base/scene/writer.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
using namespace ranges;
using Plan = CalibrationPlan;

constexpr const char *methods[] = {"bobyqa", "sbplx", "crs2"};
constexpr const char *spacings[] = {"even", "quadratic"};
constexpr const char *scales[] = {"linear", "log"};
constexpr const char *tests[] = {"drained", "undrained"};
constexpr const char *directions[] = {"compression", "extension"};
constexpr const char *strains[] = {"linear", "logarithmic"};
constexpr unsigned drained = kind_bit(LaboratoryTest::drained), undrained = kind_bit(LaboratoryTest::undrained);

// clang-format off
constexpr Section sections[] = {
  {.name = "specimens", .text = "The packings. All trials have the same seeds, so that they differ by their parameters alone."},
  {.name = "budget", .text = "When the search ends. May be changed, and the same command then goes on."},
  {.name = "optimiser", .text = "Where to look next. First the start, then a design, then the method from the best of these."},
  {.name = "misfit", .text = "How far a model curve is from that of the laboratory (apps/calibrate/README.md)."},
  {.name = "parameter", .text = "A number of the scene to be found. Which curves it can be found from is up to you.",
   .items = items_of<&Plan::parameters>, .needed = true,
   .empty_remedy = "Give for example [[parameter]] key = \"contact.friction\", bounds = [\"10 deg\", \"35 deg\"].",
   .set_example = "scale=log"},
  {.name = "curve", .text = "A laboratory curve and the test that it comes from. Strains and stresses as the direction has them: "
                            "compression positive.",
   .kind_key = "test", .items = items_of<&Plan::curves>, .needed = true,
   .empty_remedy = "Give for example [[curve]] file = \"TMD3.csv\", test = \"drained\".",
   .default_kind = "drained", .set_example = "weight=2", .kinds_title = "Tests"},
};

constexpr Key plan_keys[] = {
  {.path = "title", .kind = Kind::text, .text = "Heads tables and figures.", .field = [](Plan &p) -> Field { return &p.title; }},
  {.path = "scene", .kind = Kind::text, .presence = Presence::required, .value = "drained_dr64.toml",
   .text = "Scene file that the trials vary: grading, contact law, specimen. Its stages give way to the tests of the curves.",
   .field = [](Plan &p) -> Field { return &p.scene; }},

  {.path = "specimens.grains", .kind = Kind::integer, .value = "1000", .range = {50, 1e6},
   .reason = "because fewer are no specimen", .text = "Grains of a trial's specimens; their size is that of the scene.",
   .field = [](Plan &p) -> Field { return &p.specimens.grains; }},
  {.path = "specimens.seeds", .kind = Kind::integer, .value = "2", .range = {1, 1000},
   .text = "Specimens per curve and trial; their mean is compared with the laboratory.",
   .field = [](Plan &p) -> Field { return &p.specimens.seeds; }},
  {.path = "specimens.first_seed", .kind = Kind::integer, .value = "1", .text = "grading.seed of the first; the others follow.",
   .field = [](Plan &p) -> Field { return &p.specimens.first_seed; }},
  {.path = "specimens.full_grains", .kind = Kind::integer, .value = "10000", .range = {50, 1e8},
   .text = "Grains of the scenes that are left ready to run.",
   .field = [](Plan &p) -> Field { return &p.specimens.full_grains; }},
  {.path = "specimens.inertial_number", .presence = Presence::optional, .value = "4e-4", .range = fraction,
   .text = "Inertial number of the trials' tests; left out: as the scene says. The scenes that are left ready to run keep theirs.",
   .field = [](Plan &p) -> Field { return &p.specimens.inertial_number; }},

  {.path = "budget.trials", .kind = Kind::integer, .value = "60", .range = counts, .text = "Largest number of trials, start and design included.",
   .field = [](Plan &p) -> Field { return &p.budget.trials; }},
  {.path = "budget.time", .kind = Kind::quantity, .dimension = Dimension::interval, .unit = "min", .presence = Presence::optional,
   .value = "8 h", .range = positive, .text = "No trial is begun after this wall-clock time of a call.",
   .field = [](Plan &p) -> Field { return &p.budget.minutes; }},

  {.path = "optimiser.method", .kind = Kind::choice, .value = "bobyqa", .choices = methods,
   .text = "bobyqa: quadratic models, few trials; sbplx: simplex in subspaces, for noisy misfits; crs2: random search, for several "
           "minima. Left out with one parameter alone: sbplx.",
   .field = [](Plan &p) -> Field { return EnumField(&p.search.method); }},
  {.path = "optimiser.design", .kind = Kind::integer, .value = "8", .range = {0, 1e6},
   .text = "Trials spread evenly over the bounds before the method begins; their runs go side by side.",
   .field = [](Plan &p) -> Field { return &p.search.design; }},
  {.path = "optimiser.first_step", .value = "0.15", .range = {0, 0.5, true}, .reason = "because the bounds are 1 apart",
   .text = "First step of the method as a share of the bounds.", .field = [](Plan &p) -> Field { return &p.search.first_step; }},
  {.path = "optimiser.tolerance", .value = "0.005", .range = fraction,
   .text = "The method ends when its steps are this share of the bounds.",
   .field = [](Plan &p) -> Field { return &p.search.tolerance; }},

  {.path = "misfit.points", .kind = Kind::integer, .value = "40", .range = {2, 10000}, .text = "Strains at which curves are compared.",
   .field = [](Plan &p) -> Field { return &p.misfit.points; }},
  {.path = "misfit.spacing", .kind = Kind::choice, .value = "even", .choices = spacings,
   .text = "even, or quadratic: closer at the start, where the stiffness shows.",
   .field = [](Plan &p) -> Field { return EnumField(&p.misfit.spacing); }},
  {.path = "misfit.penalty", .value = "1", .range = positive, .text = "Misfit of a curve one of whose runs failed.",
   .field = [](Plan &p) -> Field { return &p.misfit.penalty; }},
};

constexpr Key parameter_keys[] = {
  {.path = "parameter.key", .kind = Kind::text, .presence = Presence::required, .value = "contact.friction",
   .text = "Key of the scene.", .field = [](Plan &, PlanParameter &p) -> Field { return &p.key; }},
  {.path = "parameter.bounds", .kind = Kind::value_pair, .presence = Presence::required, .value = "[\"10 deg\", \"35 deg\"]",
   .text = "Between these, in the form of the key.",
   .field = [](Plan &, PlanParameter &p) -> Field { return ValuePair{&p.low, &p.high}; }},
  {.path = "parameter.start", .kind = Kind::value, .presence = Presence::optional, .value = "\"18 deg\"",
   .text = "Left out: what the scene has if that is within the bounds, else the middle.",
   .field = [](Plan &, PlanParameter &p) -> Field { return ValueText{&p.start}; }},
  {.path = "parameter.scale", .kind = Kind::choice, .value = "linear", .choices = scales,
   .text = "log: equal steps are equal ratios; for moduli over decades.",
   .field = [](Plan &, PlanParameter &p) -> Field { return &p.logarithmic; }},
  {.path = "parameter.curve", .kind = Kind::text, .presence = Presence::optional, .value = "dense",
   .text = "Name of the only curve, or group of curves, that it belongs to (a density, say); left out: all.",
   .field = [](Plan &, PlanParameter &p) -> Field { return &p.curve; }},
};

constexpr Key curve_keys[] = {
  {.path = "curve.file", .kind = Kind::text, .presence = Presence::required, .value = "TMD3.csv",
   .text = "Table with a header, columns between commas, beside the plan.", .field = [](Plan &, PlanCurve &c) -> Field { return &c.file; }},
  {.path = "curve.test", .kind = Kind::choice, .presence = Presence::required, .value = "drained", .choices = tests,
   .kinds = drained | undrained, .text = "Monotonic triaxial test at constant lateral stress, or at constant volume.",
   .field = [](Plan &, PlanCurve &c) -> Field { return EnumField(&c.test); }},
  {.path = "curve.name", .kind = Kind::text, .presence = Presence::optional, .value = "loose",
   .text = "Names it in tables and folders; left out: the file without its ending.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.name; }},
  {.path = "curve.group", .kind = Kind::text, .presence = Presence::optional, .value = "loose",
   .text = "Of curves that share parameters, blind ones among them: those of specimens made alike.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.group; }},
  {.path = "curve.direction", .kind = Kind::choice, .value = "compression", .choices = directions,
   .text = "Of the axial strain.", .field = [](Plan &, PlanCurve &c) -> Field { return EnumField(&c.direction); }},
  {.path = "curve.relative_density", .presence = Presence::optional, .value = "0.64", .range = {0, 1},
   .reason = "because D_r is 0 at e_max and 1 at e_min", .group = "preparation", .text = "specimen.relative_density of its runs.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.relative_density; }},
  {.path = "curve.void_ratio", .presence = Presence::optional, .value = "0.67", .range = {0, 3, true},
   .reason = "because a packing of spheres in contact has no other", .group = "preparation", .text = "specimen.void_ratio of its runs.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.void_ratio; }},
  {.path = "curve.preparation_friction", .kind = Kind::quantity, .dimension = Dimension::angle, .unit = "deg",
   .presence = Presence::optional, .value = "10 deg", .range = right_angle, .reason = because_tan, .group = "preparation",
   .text = "specimen.preparation_friction of its runs. It takes one compression where a density takes several.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.preparation_friction; }},
  {.path = "curve.pressure", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "kPa", .presence = Presence::optional,
   .value = "200 kPa", .range = positive, .text = "Effective pressure before the test; left out: that of the scene.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.pressure; }},
  {.path = "curve.strain_end", .value = "0.1", .range = {0, 0.9, true}, .reason = "because this is a strain, not percent",
   .text = "Axial strain (its amount) up to which curves are compared.", .field = [](Plan &, PlanCurve &c) -> Field { return &c.strain_end; }},
  {.path = "curve.strains", .kind = Kind::choice, .value = "linear", .choices = strains,
   .text = "Strains of the file: linear, change over first height or volume; or logarithmic.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.logarithmic; }},
  {.path = "curve.weight", .value = "1", .range = positive, .text = "In the misfit of a trial.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.weight; }},
  {.path = "curve.blind", .kind = Kind::boolean, .value = "false",
   .text = "Not fitted: only computed for the start and for the best set.", .field = [](Plan &, PlanCurve &c) -> Field { return &c.blind; }},
  {.path = "curve.columns", .kind = Kind::table, .presence = Presence::optional, .value = "{ strain = \"eps_a[%]\" }",
   .text = "Names of the columns, each with its unit in brackets or parentheses at the end: %, -, Pa, kPa or MPa.",
   .field = [](Plan &, PlanCurve &) -> Field { return {}; }},
  {.path = "curve.columns.strain", .kind = Kind::text, .value = "eps_a[%]", .text = "Axial strain.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.columns.strain; }},
  {.path = "curve.columns.volume", .kind = Kind::text, .value = "eps_v[%]", .kinds = drained, .text = "Volumetric strain.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.columns.volume; }},
  {.path = "curve.columns.axial", .kind = Kind::text, .value = "sigma_v[kPa]", .kinds = drained, .text = "Axial effective stress.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.columns.axial; }},
  {.path = "curve.columns.radial", .kind = Kind::text, .value = "sigma_r[kPa]", .kinds = drained, .text = "Radial effective stress.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.columns.radial; }},
  {.path = "curve.columns.p", .kind = Kind::text, .value = "p[kPa]", .kinds = undrained, .text = "Mean effective stress p'.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.columns.p; }},
  {.path = "curve.columns.q", .kind = Kind::text, .value = "q[kPa]", .kinds = undrained, .text = "Axial minus radial stress.",
   .field = [](Plan &, PlanCurve &c) -> Field { return &c.columns.q; }},
};

constexpr KeyGroup groups[] = {{"preparation"}};
constexpr Dimension dimensions[] = {Dimension::pressure, Dimension::angle, Dimension::interval};
// clang-format on

std::string at(const char *section, std::size_t i, const char *key) { return fmt::format("{}.{}.{}", section, i, key); }

/// The names of curves are folders, and differ.
void check_names(const SceneDocument &document, CalibrationPlan &plan)
{
  for (std::size_t i = 0; i < plan.curves.size(); ++i)
    {
      PlanCurve &curve = plan.curves[i];
      const std::string key = at("curve", i, curve.name.empty() ? "file" : "name");
      if (curve.name.empty())
        curve.name = fs::path(curve.file).stem().string();
      if (curve.name.empty() || curve.name.find_first_of("/,\"\n") != std::string::npos || curve.name[0] == '.')
        document.refuse(key, "must give a name that can name a folder. Give name = \"loose\", say.");
      for (std::size_t k = 0; k < i; ++k)
        if (plan.curves[k].name == curve.name)
          document.refuse(key, fmt::format("names two curves \"{}\" (the other: {}). Give one of them another name.",
                                           curve.name, plan.curves[k].where));
      if (curve.group.empty())
        curve.group = curve.name;
      curve.where = document.where(at("curve", i, "file"));
    }
}

void check_parameters(const SceneDocument &document, CalibrationPlan &plan)
{
  const auto share_a_curve = [&](const PlanParameter &a, const PlanParameter &b) {
    return std::any_of(plan.curves.begin(), plan.curves.end(),
                       [&](const PlanCurve &curve) { return concerns(a, curve) && concerns(b, curve); });
  };
  for (std::size_t i = 0; i < plan.parameters.size(); ++i)
    {
      PlanParameter &parameter = plan.parameters[i];
      parameter.where = document.where(at("parameter", i, "key"));
      const auto fits = [&](const PlanCurve &curve) { return concerns(parameter, curve) && !curve.blind; };
      if (!parameter.curve.empty() && std::none_of(plan.curves.begin(), plan.curves.end(), fits))
        document.refuse(at("parameter", i, "curve"),
                        "is the name or group of no curve that is fitted. Give that of a [[curve]] without blind.");
      for (std::size_t k = 0; k < i; ++k)
        if (plan.parameters[k].key == parameter.key && share_a_curve(parameter, plan.parameters[k]))
          document.refuse(at("parameter", i, "key"),
                          fmt::format("is a parameter twice (the other: {}). Remove one, or give each its own curve.",
                                      plan.parameters[k].where));
    }
}

void check(const SceneDocument &document, CalibrationPlan &plan)
{
  check_groups(document, &plan);
  check_names(document, plan);
  check_parameters(document, plan);
  const auto is_fitted = [](const PlanCurve &c) { return !c.blind; };
  if (std::none_of(plan.curves.begin(), plan.curves.end(), is_fitted))
    document.refuse("curve.0.blind", "leaves no curve to fit: all are blind. Set blind = false for one of them.");
  if (plan.search.method == SearchMethod::bobyqa && plan.parameters.size() < 2)
    {
      if (document.find("optimiser.method"))
        document.refuse("optimiser.method", "\"bobyqa\" needs two parameters or more. Take \"sbplx\" for one.");
      plan.search.method = SearchMethod::sbplx;
    }
}
} // namespace

const SceneSchema &plan_schema()
{
  static const KeyTable keys{plan_keys, parameter_keys, curve_keys};
  static const SceneSchema schema{.keys = keys.keys(),
                                  .sections = sections,
                                  .groups = groups,
                                  .dimensions = dimensions,
                                  .set_example = "budget.trials=100",
                                  .defaults_head = "A calibration plan with the defaults of every key. A line \"# key "
                                                   "= value\" is a key without default, with an example."};
  return schema;
}

bool concerns(const PlanParameter &parameter, const PlanCurve &curve)
{
  return parameter.curve.empty() || parameter.curve == curve.name || parameter.curve == curve.group;
}

CalibrationPlan parse_plan(const std::string &text, const std::string &name)
{
  const SceneDocument document(plan_schema(), text, name, {});
  CalibrationPlan plan;
  fill_scene(document, &plan);
  check(document, plan);
  return plan;
}

CalibrationPlan read_plan(const std::string &path)
{
  const std::string text = read_scene_text(path);
  const SceneDocument document(plan_schema(), text, path, {});
  CalibrationPlan plan = parse_plan(text, path);
  const std::string shipped = shipped_scene(plan.scene);
  const bool is_beside = fs::is_regular_file(fs::path(path).parent_path() / plan.scene);
  plan.scene_path = is_beside || shipped == plan.scene ? found_file(document, "scene", path, plan.scene) : shipped;
  for (std::size_t i = 0; i < plan.curves.size(); ++i)
    plan.curves[i].path = found_file(document, at("curve", i, "file"), path, plan.curves[i].file);
  return plan;
}

std::string to_toml(const CalibrationPlan &plan) { return write_scene(plan_schema(), &plan); }

std::string default_plan() { return write_defaults(plan_schema()); }
} // namespace isostat
