// SPDX-License-Identifier: BSD-3-Clause
// The representative volume element.   tested: tests/python/rve_test.py
#include "dem/rve/rve.hpp"
#include "base/error.hpp"
#include "python/binding/binding.hpp"
#include "python/binding/given.hpp"

#include <atomic>
#include <fmt/format.h>

namespace isostat::python
{
namespace
{
using InertialNumber = Given<std::optional<double>, "inertial_number">;
using Damping = Given<std::optional<double>, "damping">;
using StrainRate = Given<std::optional<double>, "strain_rate">;
using Frame = Given<std::optional<Mat3>, "frame">;
using MinSteps = Given<std::uint64_t, "min_steps">;
using MaxIncrement = Given<double, "max_increment">;
using MaxSteps = Given<std::uint64_t, "max_steps">;
using Increment = Given<std::optional<double>, "increment">;
using Tolerance = Given<double, "balance">;
using LeftOut = Given<double, "left_out">;
using Gradient = Given<Mat3, "gradient">;

constexpr BalanceSpec default_balance;

/// Keys of [motion] that are given, over the defaults of an element.
RveSettings settings_of(const InertialNumber &inertial_number, const Damping &damping, const StrainRate &strain_rate,
                        const Frame &frame, MinSteps min_steps, MaxIncrement max_increment, MaxSteps max_steps,
                        const Increment &increment, Tolerance balance, LeftOut left_out)
{
  RveSettings settings;
  settings.motion = controlled_motion();
  if (inertial_number.value)
    settings.motion.inertial_number = inertial_number;
  if (damping.value)
    settings.motion.damping = *damping.value;
  if (strain_rate.value)
    settings.motion.strain_rate = strain_rate;
  if (frame.value)
    settings.frame = *frame.value;
  settings.min_steps = min_steps;
  settings.max_increment = max_increment;
  settings.max_steps = max_steps;
  if (increment.value)
    settings.stepping = StaticStepping{*increment.value, {balance, left_out}};
  settings.go_on = [] {
    const py::gil_scoped_acquire gil;
    return PyErr_CheckSignals() == 0;
  };
  return settings;
}

/// An element as Python holds it. The GIL is released while it works, so another thread could come in.
struct Element
{
  Rve rve;
  std::atomic<bool> in_use = false;

  explicit Element(Rve &&rve_) : rve(std::move(rve_)) {}
};

/// As long as it lives this thread alone has the element.   @throws RunFailure  another one has it
class Use
{
public:
  explicit Use(Element &element) : element_(element)
  {
    if (element.in_use.exchange(true))
      throw RunFailure("this element is in use by another thread: give each thread an element of its own, or wait");
  }
  ~Use() { element_.in_use = false; }
  Use(const Use &) = delete;
  Use &operator=(const Use &) = delete;

private:
  Element &element_;
};

/// A method of the element for one thread at a time.
template <typename Returned, typename... Argument>
auto alone(Returned (*function)(Rve &, Argument...))
{
  return [function](Element &element, Argument... argument) {
    const Use use(element);
    return function(element.rve, std::forward<Argument>(argument)...);
  };
}

/// An increment without the GIL. Ctrl-C takes it back and raises KeyboardInterrupt.
template <typename Increment>
RveResponse taken(const Increment &increment)
{
  const RveResponse response = [&] {
    const py::gil_scoped_release free;
    return increment();
  }();
  if (PyErr_Occurred())
    throw py::error_already_set();
  return response;
}

RveResponse advance(Rve &rve, const Gradient &gradient)
{
  return taken([&] { return rve.advance(gradient); });
}

RveResponse undrained(Rve &rve, const Gradient &gradient)
{
  return taken([&] { return rve.undrained(gradient); });
}

RveResponse relax(Rve &rve, Tolerance balance, LeftOut left_out)
{
  return taken([&] { return rve.relax({balance, left_out}); });
}

RveResponse mixed(Rve &rve, const Gradient &gradient, const Given<Mat3, "stress"> &stress,
                  const Given<Eigen::Matrix<bool, 3, 3>, "controlled"> &controlled,
                  Given<double, "tolerance"> tolerance)
{
  return taken([&] { return rve.advance(MixedIncrement{gradient, stress, controlled, tolerance}); });
}

Mat6 stiffness(Rve &rve, bool yielding_contacts_resist)
{
  const py::gil_scoped_release free;
  return rve.stiffness(yielding_contacts_resist ? Sliding::elastic : Sliding::plastic);
}

py::bytes packed(Rve &rve)
{
  const std::vector<std::byte> bytes = rve.pack();
  return {reinterpret_cast<const char *>(bytes.data()), bytes.size()};
}

void bind_response(py::module_ &module)
{
  py::class_<RveResponse>(module, "RveResponse", "What an increment gave.")
      .def_property_readonly(
          "accepted", [](const RveResponse &r) { return r.outcome == RveOutcome::accepted; },
          "False: rejected, and the state is that before the call.")
      .def_readonly("reason", &RveResponse::reason, "Why it was rejected.")
      .def_readonly("stress", &RveResponse::stress, "Cauchy effective stress, (3, 3), Pa, tension positive.")
      .def_readonly("mean_stress_change", &RveResponse::mean_stress_change, "Of tr(stress)/3, Pa, tension positive.")
      .def_readonly("steps", &RveResponse::steps, "Time steps, force evaluations, it took.")
      .def_property_readonly(
          "balance", [](const RveResponse &r) { return r.balance.within; },
          "Largest imbalance of the loaded grains except those left out [-]; of static stepping and relax().")
      .def_property_readonly(
          "worst_balance", [](const RveResponse &r) { return r.balance.worst; }, "That of the worst grain [-].")
      .def_readonly("indicator", &RveResponse::indicator, "Quasi-static error indicator.")
      .def("__bool__", [](const RveResponse &r) { return r.outcome == RveOutcome::accepted; })
      .def("__repr__", [](const RveResponse &r) {
        return r.outcome == RveOutcome::accepted ? fmt::format("<isostat.RveResponse accepted, {} steps>", r.steps)
                                                 : fmt::format("<isostat.RveResponse rejected: {}>", r.reason);
      });
}
} // namespace

void bind_rve(py::module_ &module)
{
  bind_response(module);
  py::class_<RveState>(module, "RveState", "The complete state of an element; for restore().")
      .def_property_readonly("bytes", &RveState::bytes, "Memory it takes.");
  py::class_<Element>(module, "Rve",
                      "A periodic packing as a material point: strain in, stress out. Nothing moves between calls. One "
                      "thread at a time\n"
                      "may use it; another one gets a RunFailure. Displacement gradients (3, 3) are relative to the "
                      "present shape; stress\n"
                      "is the Cauchy effective stress, tension positive, Pa.")
      .def(py::init([](const Given<const Snapshot *, "specimen"> &specimen, const InertialNumber &inertial_number,
                       const Damping &damping, const StrainRate &strain_rate, const Frame &frame, MinSteps min_steps,
                       MaxIncrement max_increment, MaxSteps max_steps, const Increment &increment, Tolerance balance,
                       LeftOut left_out) {
             return std::make_unique<Element>(
                 Rve(*specimen.value, settings_of(inertial_number, damping, strain_rate, frame, min_steps,
                                                  max_increment, max_steps, increment, balance, left_out)));
           }),
           py::arg("specimen"), py::kw_only(), py::arg("inertial_number") = py::none(), py::arg("damping") = py::none(),
           py::arg("strain_rate") = py::none(), py::arg("frame") = py::none(), py::arg("min_steps") = 1,
           py::arg("max_increment") = 0.01, py::arg("max_steps") = 10'000'000, py::arg("increment") = py::none(),
           py::arg("balance") = default_balance.tolerance, py::arg("left_out") = default_balance.left_out,
           "specimen: a periodic packing at rest.\n"
           "inertial_number, damping (local) [-], strain_rate (1/s): as the keys of [motion]; None: what columns use.\n"
           "frame: rotation (3, 3), x_lab = frame x_specimen.\n"
           "min_steps: time steps that an increment takes at least; with few of them small strains are not "
           "quasi-static.\n"
           "max_increment: norm of the gradient above which an increment is rejected [-], at most 0.1.\n"
           "max_steps: an increment that takes more time steps is rejected.\n"
           "increment: strain [-]; increments are divided into parts of at most this, each taken to balance without "
           "inertia;\n"
           "rate and damping do not count then. None: time steps at a rate.\n"
           "balance: largest imbalance of a grain, force or torque/radius over the largest contact force on it [-].\n"
           "left_out: share of the loaded grains, the worst, for which balance need not hold [-].\n"
           "Ctrl-C undoes an increment. Raises InputError for settings out of range, naming it.")
      .def("advance", alone(&advance), py::arg("gradient"),
           "Strains it by a displacement gradient (3, 3), extension positive.")
      .def("undrained", alone(&undrained), py::arg("gradient"),
           "The same without its volumetric part; extension positive.")
      .def("relax", alone(&relax), py::arg("balance") = default_balance.tolerance,
           py::arg("left_out") = default_balance.left_out,
           "Takes the grains to balance at the present strain; both arguments as those of the element.")
      .def("mixed", alone(&mixed), py::arg("gradient"), py::arg("stress"), py::arg("controlled"),
           py::arg("tolerance") = 1e-3,
           "Prescribed strain in some components, target stress where `controlled` is true.\n\n"
           "gradient: displacement gradient (3, 3), extension positive; its symmetric part is 0 where stress is "
           "controlled.\n"
           "stress: target (3, 3), Pa, tension positive: compression is negative, not as in a history. Symmetric where "
           "it is\ncontrolled, not used elsewhere.\n"
           "controlled: (3, 3), symmetric. tolerance: of the stress, over p' [-].\n"
           "Rejected at once: a target that needs tension, a component with strain and stress, a frame other than "
           "identity.\nRejected on the way: stress control strains it by more than 0.1, or takes max_steps.")
      .def_property_readonly("stress", alone(+[](Rve &rve) { return rve.stress(); }), "(3, 3), Pa, tension positive.")
      .def_property_readonly("void_ratio", alone(+[](Rve &rve) { return rve.void_ratio(); }), "e.")
      .def_property_readonly("dry_density", alone(+[](Rve &rve) { return rve.dry_density(); }),
                             "Of the skeleton, kg/m3.")
      .def("stiffness", alone(&stiffness), py::arg("yielding_contacts_resist") = true, "As Snapshot.stiffness().")
      .def("snapshot", alone(+[](Rve &rve) { return std::make_shared<Snapshot>(rve.snapshot()); }),
           "A copy of the packing with its contacts, in the laboratory frame.")
      .def("save", alone(+[](Rve &rve) { return rve.save(); }), "Its complete state, for restore().")
      .def("restore", alone(+[](Rve &rve, Given<const RveState *, "state"> state) { rve.restore(*state); }),
           py::arg("state"), "Of this element, or of one with the same grains and law.")
      .def("pack", alone(&packed), "The element as bytes for another process on the same type of machine.")
      .def_static(
          "unpack",
          [](const std::string &bytes, const InertialNumber &inertial_number, const Damping &damping,
             const StrainRate &strain_rate, const Frame &frame, MinSteps min_steps, MaxIncrement max_increment,
             MaxSteps max_steps, const Increment &increment, Tolerance balance, LeftOut left_out) {
            return std::make_unique<Element>(
                Rve::unpack(std::as_bytes(std::span(bytes.data(), bytes.size())),
                            settings_of(inertial_number, damping, strain_rate, frame, min_steps, max_increment,
                                        max_steps, increment, balance, left_out)));
          },
          py::arg("bytes"), py::kw_only(), py::arg("inertial_number") = py::none(), py::arg("damping") = py::none(),
          py::arg("strain_rate") = py::none(), py::arg("frame") = py::none(), py::arg("min_steps") = 1,
          py::arg("max_increment") = 0.01, py::arg("max_steps") = 10'000'000, py::arg("increment") = py::none(),
          py::arg("balance") = default_balance.tolerance, py::arg("left_out") = default_balance.left_out,
          "The element that pack() gave, with the same settings.");
}
} // namespace isostat::python
