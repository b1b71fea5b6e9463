// SPDX-License-Identifier: BSD-3-Clause
// The keys of a scene file. Those of the contact laws, of the motion and of each kind of stage are next to their
// structs and are spliced in. A new one of the others is an entry here and a member in dem/scene/scene.hpp. Rules that
// bind several keys are in dem/scene/checks.cpp.
#include "dem/scene/schema.hpp"

#include "base/scene/fragment.hpp"
#include "base/scene/ranges.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
constexpr const char *curve_choices[] = {"karlsruhe-fine-sand"};
constexpr const char *domain_choices[] = {"rigid-box", "periodic-cell"};
constexpr const char *consolidation_choices[] = {"isotropic", "k0"};
constexpr const char *snapshot_choices[] = {"none", "reversals", "strain"};

constexpr Section fixed_sections[] = {
    {.name = "sand",
     .text =
         "The sand that the scene is of. In place of this table a scene has `sand = \"NAME\"`, an installed sand "
         "(`isostat sands`), or `sand = \"my_sand.toml\"`, a file of the user, which counts from the folder of the "
         "scene. The file has this table, `[grading]`, `[contact]` and `[specimen]`; what the scene says itself goes "
         "first."},
    {.name = "grading",
     .text = "Grain sizes and the random cloud of non-overlapping spheres the specimen starts from. Grains must be "
             "between 2 um and 300 mm across."},
    {.name = "contact",
     .text = "The contact law. A part that is left out costs nothing: without `friction` contacts are frictionless, "
             "without the table `rolling` or `twisting` that part of the law is not compiled into the loop that runs."},
    {.name = "specimen",
     .text = "How the specimen is made. Give exactly one of `relative_density`, `void_ratio`, `preparation_friction` "
             "and `file`."},
    {.name = "motion",
     .text =
         "Equations of motion and their time step. The rate of loading follows from an inertial number, or is fixed."},
    {.name = "control",
     .text = "A stage that shears is out of control when a stress that it keeps (drained and constant-p: the lateral "
             "ones; path: all that are prescribed) is off its target, or when inertia is too large. The summary and "
             "the terminal report stage, quantity, target and worst value."},
    {.name = "stage",
     .text =
         "The programme: every `[[stage]]` is one step of the test, in the order of the file. Without any, the scene "
         "only prepares its specimen. A key that does not belong to the kind of its stage is an error. Axes: y is "
         "vertical, the axis of the triaxial kinds; simple shear moves planes normal to y along x, its strain is "
         "gamma_xy and its stress tau = sigma_xy.",
     .kind_key = "kind",
     .items = items_of<&Scene::stages>,
     .empty_remedy = "Leave it out if the scene only prepares a specimen.",
     .default_kind = "undrained-cyclic",
     .set_example = "strain=0.02",
     .kinds_title = "Stage kinds"},
    {.name = "output", .text = "What is written, and how often. Output never changes a trajectory."},
};

using ranges::because_stresses, ranges::because_tan, ranges::fraction, ranges::positive, ranges::right_angle,
    ranges::stresses;
constexpr const char *because_damping = "because at 1 no grain would move";

// clang-format off
constexpr Key title_key[] = {
  {.path = "title", .field = member<&Scene::title>, .text = "What the scene shows; heads tables and figures."},
};

constexpr Key grading_keys[] = {
  {.path = "curve", .field = member<&GradingSpec::curve>, .value = "karlsruhe-fine-sand", .choices = curve_choices,
   .group = "size_curve", .text = "Grading curve by name; excludes `table`."},
  {.path = "table", .field = member<&GradingSpec::table>, .unit = unit::mm, .presence = Presence::optional,
   .value = "[[\"0.1 mm\", 0], [\"0.2 mm\", 100]]", .group = "size_curve",
   .text = "Grading curve as rows of diameter and percent finer by mass, both rising, the last at 100; excludes "
           "`curve`."},
  {.path = "truncate",
   .field = [](GradingSpec &g) { return PercentPair{&g.finest_percent, &g.coarsest_percent}; },
   .value = "[0, 100]", .range = {0, 100}, .reason = "because these are percentages finer",
   .text = "Percentages finer between which the curve is kept; the tails beyond are cut and the rest is rescaled."},
  {.path = "grains", .field = member<&GradingSpec::grains>, .value = "10000", .range = {2, 1e8},
   .reason = "because one grain makes no packing and more do not fit in memory", .text = "Number of spheres."},
  {.path = "cloud_edge", .field = member<&GradingSpec::cloud_edge>, .unit = unit::mm, .value = "10 mm",
   .range = positive, .group = "grain_size",
   .text = "Edge of the cube that holds the cloud; excludes `d50`. Left out: grains are as large as those of 10,000 "
           "in 10 mm."},
  {.path = "d50", .field = member<&GradingSpec::d50>, .unit = unit::mm, .presence = Presence::optional,
   .value = "0.45 mm", .range = positive, .group = "grain_size",
   .text = "Median diameter by mass of the grains, whatever their number: the curve keeps its shape, and the edge of "
           "the cube follows. Excludes `cloud_edge`."},
  {.path = "solid_fraction", .field = member<&GradingSpec::solid_fraction>, .value = "0.33", .range = {0, 0.5, true},
   .reason = "because a denser cloud cannot be filled at random",
   .text = "Solid volume of the cloud over that of its cube; with the edge it sets by how much the grains are scaled "
           "up, with `d50` the edge."},
  {.path = "density", .field = member<&GradingSpec::density>, .unit = unit::kg_m3, .value = "2650 kg/m3",
   .range = {lightest_grains, heaviest_grains}, .reason = "because less is meant in g/cm3 and more in g/m3",
   .text = "Density of the grains. Packings of other programs have the same range."},
  {.path = "seed", .field = member<&GradingSpec::seed>, .value = "1",
   .text = "Realisation: the same seed gives the same specimen on any number of threads."},
};

constexpr Key specimen_keys[] = {
  {.path = "domain", .field = member<&SpecimenSpec::domain>, .value = "rigid-box", .choices = domain_choices,
   .text = "What bounds the grains: six rigid frictionless walls, or a cell that repeats itself along x, y and z."},
  {.path = "consolidation", .field = member<&SpecimenSpec::consolidation>, .value = "isotropic",
   .choices = consolidation_choices,
   .text = "How it is compressed: with equal stresses on all axes, or along y without lateral strain (k0, in the "
           "periodic-cell only; not together with `file`)."},
  {.path = "pressure", .field = member_of<SpecimenSpec, &SpecimenSpec::pressure>, .unit = unit::kPa,
   .value = "200 kPa", .range = stresses, .reason = because_stresses,
   .text = "Effective stress to which it is compressed: isotropic, p0'; with consolidation k0 the vertical one. At "
           "most a twentieth of the modulus of contacts, which for the linear law is `young`."},
  {.path = "relative_density", .field = member<&SpecimenSpec::relative_density>, .presence = Presence::experiment,
   .value = "0.64", .range = {0, 1}, .reason = "because D_r is 0 at e_max and 1 at e_min", .group = "preparation",
   .text = "Target D_r = (e_max-e)/(e_max-e_min); a search finds the preparation friction."},
  {.path = "void_ratio", .field = member<&SpecimenSpec::void_ratio>, .presence = Presence::optional, .value = "0.67",
   .range = {0, 3, true}, .reason = "because a packing of spheres in contact has no other", .group = "preparation",
   .text = "Target void ratio e; a search finds the preparation friction."},
  {.path = "preparation_friction", .field = member<&SpecimenSpec::preparation_friction>, .unit = unit::deg,
   .presence = Presence::optional, .value = "10 deg", .range = right_angle, .reason = because_tan,
   .group = "preparation", .text = "Angle of friction while it is compressed; the density is the result."},
  {.path = "expansion", .field = member<&SpecimenSpec::expansion>, .value = "0", .range = {0, 0.1},
   .reason = "because a packing that is opened by more is a cloud without memory; 0.006 to 0.03 have been used",
   .text = "Linear strain by which the compacted packing is opened. Its grains are shaken and it is compressed again "
           "with the friction of the test: nearly as dense, with fewer contacts. 0: it is not. Not together with "
           "`file`, as `density_tolerance` and `damping`."},
  {.path = "file", .field = member<&SpecimenSpec::file>, .presence = Presence::optional, .value = "specimens/dr64.h5",
   .group = "preparation",
   .text = "A prepared specimen or a snapshot (.h5), or an entry of a library of specimens (\"library.h5#s0007\"). "
           "Convert packings of other programs with `isostat convert FILE packing.h5`. The path is relative to the "
           "folder of the scene file, or else to the working directory."},
  {.path = "e_min", .field = member<&SpecimenSpec::e_min>, .value = "0.568", .range = positive,
   .text = "Void ratio at D_r = 1. The default is that of the paper's packings of Karlsruhe fine sand; no default "
           "with `table` or `file`. Below `e_max`; give both or neither."},
  {.path = "e_max", .field = member<&SpecimenSpec::e_max>, .value = "0.841", .range = positive,
   .text = "Void ratio at D_r = 0. The default is that of the paper's packings of Karlsruhe fine sand; no default with "
           "`table` or `file`."},
  {.path = "density_tolerance", .field = member<&SpecimenSpec::density_tolerance>, .value = "0.01", .range = fraction,
   .text = "Error allowed in the D_r reached; without e_min and e_max, e may be off by 0.3 times it."},
  {.path = "damping", .field = member<&SpecimenSpec::damping>, .value = "0.3", .range = {0, 1, false, true},
   .reason = because_damping, .text = "Local damping coefficient during preparation."},
  {.path = "compaction_rate", .field = member_of<SpecimenSpec, &SpecimenSpec::compaction_rate>, .unit = unit::per_s,
   .value = "60 1/s", .range = positive,
   .text = "Largest strain rate of compaction; half of it once half of the pressure is reached."},
  {.path = "cache", .field = member<&SpecimenSpec::cache>, .value = "specimens",
   .text = "Folder of prepared specimens, counted from the parent of the output folder."},
};

constexpr Key output_keys[] = {
  {.path = "folder", .field = member<&OutputSpec::folder>, .presence = Presence::optional, .value = "results/my-run",
   .text = "Folder of the run; left out: results/ and the name of the scene file."},
  {.path = "record_stress", .field = member_of<OutputSpec, &OutputSpec::record_stress>, .unit = unit::kPa,
   .value = "1 kPa", .range = positive,
   .text = "A row of the history is due whenever p' or q (in simple shear p' or tau) has moved by this much."},
  {.path = "record_strain", .field = member_of<OutputSpec, &OutputSpec::record_strain>, .value = "1e-4",
   .range = positive,
   .text = "A row of the history is due whenever the axial strain (in simple shear gamma_xy) has moved by this much, "
           "in a path that turns at a strain by 1/25 of that if it is less; in a path that drives nothing whenever any "
           "stress has moved by `record_stress` or any strain by this much."},
  {.path = "record_steps", .field = member_of<OutputSpec, &OutputSpec::record_steps>, .value = "5000",
   .range = {1, 1e18}, .text = "A row of the history is due after this many time steps at the latest."},
  {.path = "snapshots", .field = member_of<OutputSpec, &OutputSpec::snapshots>, .value = "reversals",
   .choices = snapshot_choices,
   .text = "Whole packings are stored never, at reversals and ends of stages, or by strain."},
  {.path = "snapshot_strain", .field = member_of<OutputSpec, &OutputSpec::snapshot_strain>, .value = "0.01",
   .range = positive, .text = "Spacing in axial strain (in simple shear in gamma_xy) of the snapshots by strain."},
  {.path = "paraview", .field = member<&OutputSpec::paraview>, .value = "true",
   .text = "Write snapshots for ParaView too."},
  {.path = "energy", .field = member<&OutputSpec::energy>, .value = "false",
   .text = "Energy balance in the history; runs the loop that sums dissipation."},
  {.path = "yield_margin", .field = member<&OutputSpec::yield_margin>, .value = "1e-9", .range = {0, 1, false, true},
   .reason = "because it is a share",
   .text = "A contact counts as sliding or rolling in I_R and shares of the history where its force or moment is below "
           "the limit by this share at most. In balance contacts have mostly come off their limits: theory, section "
           "13."},
  {.path = "checkpoint", .field = member<&OutputSpec::checkpoint_minutes>, .unit = unit::min, .value = "5 min",
   .range = positive, .text = "Wall-clock time between checkpoints."},
};
// clang-format on

constexpr KeyGroup groups[] = {{"size_curve"}, {"grain_size"}, {"preparation", "relative_density = 0.64"}, {"rate"}};

constexpr Dimension dimensions[] = {Dimension::length,   Dimension::pressure,   Dimension::angle,
                                    Dimension::rate,     Dimension::time,       Dimension::density,
                                    Dimension::interval, Dimension::stress_rate};

// clang-format off
constexpr const char *defaults_head =
    "An Isostat scene with the defaults of every key. A line \"# key = value\" is a key without default, with an "
    "example. What makes the experiment (friction, rolling, twisting, the density, the stages) has no default and "
    "shows an example.";

constexpr const char *manual_head =
R"(# Scene reference

A scene is one TOML file that describes a run. This page is generated from the table in
`dem/scene/schema.cpp` (`scene_manual()`); a test compares them. Ready scenes are in `apps/scenes`.

- Quantities are text with a unit: `"10 mm"`, `"200 kPa"`, `"18 deg"`, `"0.5 1/s"`, `"2650 kg/m3"`, `"50 ns"`.
  A bare number, or the unit of something else, is an error. What has no dimension is a plain number.
- Friction is an angle in files (`deg`, `rad`, or its tangent as `"0.325 tan"`) and a coefficient tan(phi) inside.
- Numbers other than 0 are between 1e-30 and 1e30 in size, in SI units.
- An unknown key is an error, and so is a repeated key. Stresses are effective; compression is positive.
- A key written `rolling.limit` is `limit` in the table `rolling`: `rolling = { limit = 0.5 }`, or `rolling.limit = 0.5`.
- `--set key=value` on the command line overrides the file: `--set motion.damping=0.3`,
  `--set specimen.pressure="200 kPa"`, `--set stage.0.strain=0.02`. Of keys that exclude each other, the one set this
  way replaces the one in the file.

)";
// clang-format on

/// A rigid box is always consolidated isotropically, the default law needs no name, and without stages nothing is
/// controlled. Not writing them keeps the recipes of specimens that are in caches. A packing from a file has grains and
/// a stress of its own, against which only what was written is held.
bool is_implied(const Key &key, StructRef scene)
{
  const Scene &s = scene.as<Scene>();
  const std::string_view path = key.path;
  return (path == "specimen.consolidation" && s.specimen.domain == "rigid-box") ||
         (path == "contact.law" && is_default(s.contact)) ||
         (path == "specimen.expansion" && s.specimen.expansion == 0) ||
         (path.starts_with("control.") && s.stages.empty() && s.control == ControlSpec{}) ||
         (path.starts_with("grading.") && !s.specimen.file.empty() && !s.written.has(path)) ||
         (path == "specimen.pressure" && !takes_pressure(s) && !s.written.has(path) &&
          s.specimen.pressure == SpecimenSpec{}.pressure) ||
         (s.drive.on ? path == "motion.load_per_wave"
                     : path == "motion.increment" || path == "motion.balance" || path == "motion.left_out");
}

std::string_view kind_name(const Law &law) { return law->name(); }
std::string_view kind_name(const Stage &stage) { return behaviour(stage).kind(); }

/// Which of the kinds a value is, by its name; setting it makes that kind with its defaults.
template <class Value>
EnumField kind_field(Value &value, std::span<const Value> kinds)
{
  return {[&value, kinds] {
            const auto is_it = [&](const Value &kind) { return kind_name(kind) == kind_name(value); };
            return static_cast<std::size_t>(std::ranges::find_if(kinds, is_it) - kinds.begin());
          },
          [&value, kinds](std::size_t number) { value = kinds[number]; }};
}

template <class Value>
std::vector<const char *> names_of(std::span<const Value> kinds)
{
  std::vector<const char *> names;
  for (const Value &kind : kinds)
    names.push_back(kind_name(kind).data());
  return names;
}

/// The tables together with the keys of all laws that there are when the first scene is read.
struct WholeSchema
{
  std::vector<const char *> law_names = names_of(registered_laws()), stage_names = names_of(stage_kinds());
  Key law_key[1] = {{.path = "law",
                     .field = [](Scene &s) { return kind_field(s.contact, registered_laws()); },
                     .value = law_names[0],
                     .choices = law_names,
                     .text = "The contact law."}};
  Key stage_key[1] = {{.path = "kind",
                       .field = [](Stage &stage) { return kind_field(stage, stage_kinds()); },
                       .presence = Presence::required,
                       .value = "undrained-monotonic",
                       .choices = stage_names,
                       .kinds = (1u << stage_names.size()) - 1,
                       .text = "What the laboratory does; k0-compress and both kinds of simple shear need the domain "
                               "periodic-cell."}};
  std::vector<Section> sections{std::begin(fixed_sections), std::end(fixed_sections)};
  std::optional<KeyTable> table;
  SceneSchema schema;

  WholeSchema()
  {
    const std::span<const Law> laws = registered_laws();
    std::vector<KeyRun> runs{title_key, splice<&Scene::sand>("sand", sand_keys()),
                             splice<&Scene::grading>("grading", grading_keys), KeyRun(law_key, "contact")};
    for (std::size_t i = 0; i < laws.size(); ++i)
      runs.emplace_back(laws[i]->keys(), "contact", laws.size() > 1 ? 1u << i : 0u,
                        [](Scene &s) -> ContactLaw & { return *s.contact.operator->(); });
    for (const KeyRun &run :
         {splice<&Scene::specimen>("specimen", specimen_keys), splice<&Scene::motion>("motion", motion_keys()),
          splice<&Scene::drive>("motion", static_drive_keys()), splice<&Scene::control>("control", control_keys()),
          KeyRun(stage_key, "stage"),
          splice("stage", stage_keys(), 0, [](Stage &stage) -> StageBehaviour & { return behaviour(stage); }),
          splice<&Scene::output>("output", output_keys)})
      runs.push_back(run);
    table.emplace(std::span<const KeyRun>(runs));
    for (Section &section : sections)
      if (laws.size() > 1 && section.name == "contact")
        section.kind_key = "law", section.kinds_title = "Laws";
    schema = {.keys = table->keys(),
              .sections = sections,
              .groups = groups,
              .dimensions = dimensions,
              .set_example = "motion.damping=0.3",
              .defaults_head = defaults_head,
              .manual_head = manual_head,
              .is_implied = is_implied};
  }
};
} // namespace

bool takes_pressure(const Scene &scene)
{
  return scene.specimen.file.empty() || std::ranges::any_of(scene.stages, [](const Stage &stage) {
           const auto *servo = as<ServoStage>(stage);
           return servo && servo->pressure == 0;
         });
}

const SceneSchema &scene_schema()
{
  static const WholeSchema whole;
  return whole.schema;
}
} // namespace isostat
