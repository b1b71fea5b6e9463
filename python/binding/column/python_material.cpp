// SPDX-License-Identifier: BSD-3-Clause
#include "python/binding/column/python_material.hpp"

#include "base/error.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat::python
{
namespace
{
/// A read-only array (n, columns...) with a copy of the values: a law may keep it.
py::array_t<double> copied(const double *first, std::vector<py::ssize_t> shape)
{
  py::array_t<double> array(std::move(shape), first);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// The arrays of a state are only read from now on.
py::object frozen(py::object state)
{
  if (py::isinstance<py::dict>(state))
    for (const auto &[key, value] : py::cast<py::dict>(state))
      if (py::isinstance<py::array>(value))
        py::detail::array_proxy(value.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return state;
}
} // namespace

PythonMaterial::PythonMaterial(py::object law, std::string layer, std::size_t n_points)
    : law_(std::move(law)), committed_(py::none()), trial_(py::none()), layer_(std::move(layer)), n_points_(n_points)
{}

PythonMaterial::~PythonMaterial()
{
  const py::gil_scoped_acquire gil;
  law_ = committed_ = trial_ = py::object();
}

std::string PythonMaterial::name() const
{
  const py::gil_scoped_acquire gil;
  return py::str(py::type::of(law_).attr("__name__"));
}

PythonMaterial::Array PythonMaterial::shaped(const py::object &value, const char *what,
                                             std::vector<std::size_t> shape) const
{
  shape.insert(shape.begin(), n_points_);
  const Array array = Array::ensure(value);
  if (!array)
    throw py::error_already_set();
  const std::vector<std::size_t> found(array.shape(), array.shape() + array.ndim());
  if (found != shape)
    throw InputError(fmt::format("material of layer \"{}\": {} must be an array of shape ({}), but has ({}).", layer_,
                                 what, fmt::join(shape, ", "), fmt::join(found, ", ")));
  for (std::size_t k = 0, per_point = static_cast<std::size_t>(array.size()) / n_points_; k < n_points_ * per_point;
       ++k)
    if (!std::isfinite(array.data()[k]))
      throw RunFailure(
          fmt::format("material of layer \"{}\": {} of point {} is not finite", layer_, what, k / per_point));
  return array;
}

void PythonMaterial::set_initial_stress(std::span<const Stress> effective)
{
  const py::gil_scoped_acquire gil;
  committed_ = frozen(law_.attr("initial")(copied(effective.front().data(), {static_cast<py::ssize_t>(n_points_), 6})));
  trial_ = py::none();
}

void PythonMaterial::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  const py::gil_scoped_acquire gil;
  const py::object answer =
      law_.attr("update")(committed_, copied(increments.front().data(), {static_cast<py::ssize_t>(n_points_), 3, 3}));
  if (!py::isinstance<py::tuple>(answer) || py::len(answer) != 2)
    throw InputError(fmt::format("material of layer \"{}\": update() must return (stress, state).", layer_));
  const auto both = answer.cast<py::tuple>();
  const Array stress = shaped(both[0], "the stress", {6});
  trial_ = frozen(both[1]);
  std::memcpy(stresses.data(), stress.data(), n_points_ * sizeof(Stress));
}

void PythonMaterial::commit()
{
  const py::gil_scoped_acquire gil;
  if (!trial_.is_none())
    committed_ = std::exchange(trial_, py::none());
}

void PythonMaterial::rollback()
{
  const py::gil_scoped_acquire gil;
  trial_ = py::none();
}

void PythonMaterial::stiffness(std::span<Stiffness> tangents) const
{
  const py::gil_scoped_acquire gil;
  const Array found = shaped(law_.attr("stiffness")(trial_.is_none() ? committed_ : trial_), "the stiffness", {6, 6});
  using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  for (std::size_t q = 0; q < n_points_; ++q)
    tangents[q] = Eigen::Map<const RowMajor>(found.data() + 36 * q);
}

void PythonMaterial::wave_moduli(std::span<WaveModuli> moduli) const
{
  const py::gil_scoped_acquire gil;
  const Array found = shaped(law_.attr("wave_moduli")(committed_), "the wave moduli", {2});
  for (std::size_t q = 0; q < n_points_; ++q)
    {
      moduli[q] = {found.at(q, 0), found.at(q, 1)};
      if (!(moduli[q].p > 0 && moduli[q].s >= 0))
        throw InputError(fmt::format("material of layer \"{}\": wave moduli of point {} are {:.4g} and {:.4g} Pa; must "
                                     "be above 0 and not below 0 because no wave runs otherwise. Is the stiffness "
                                     "positive definite?",
                                     layer_, q, moduli[q].p, moduli[q].s));
    }
}

MaterialState PythonMaterial::pack() const
{
  const py::gil_scoped_acquire gil;
  const auto packed = law_.attr("pack")(committed_).cast<std::string>();
  const auto *first = reinterpret_cast<const std::byte *>(packed.data());
  return {{first, first + packed.size()}, {}};
}

void PythonMaterial::unpack(const MaterialState &state)
{
  const py::gil_scoped_acquire gil;
  committed_ =
      frozen(law_.attr("unpack")(py::bytes(reinterpret_cast<const char *>(state.common.data()), state.common.size())));
  trial_ = py::none();
}
} // namespace isostat::python
