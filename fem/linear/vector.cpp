// SPDX-License-Identifier: BSD-3-Clause
#include "fem/linear/vector.hpp"

#include <deal.II/lac/la_parallel_vector.h>

#include <utility>

namespace isostat
{
struct Vector::Values : dealii::LinearAlgebra::distributed::Vector<double>
{
  using dealii::LinearAlgebra::distributed::Vector<double>::Vector;
  using dealii::LinearAlgebra::distributed::Vector<double>::operator=;
};

void Vector::find_values()
{
  values_ = of_dealii_->begin();
  n_owned_ = of_dealii_->locally_owned_size();
}

Vector::Vector() : of_dealii_(std::make_unique<Values>()) { find_values(); }

Vector::Vector(const VectorPartition &partition) : of_dealii_(std::make_unique<Values>(partition)) { find_values(); }

Vector::Vector(const Vector &other) : of_dealii_(std::make_unique<Values>(*other.of_dealii_)) { find_values(); }

Vector::Vector(Vector &&other) noexcept { swap(other); }

Vector &Vector::operator=(const Vector &other)
{
  if (!of_dealii_)
    of_dealii_ = std::make_unique<Values>();
  *of_dealii_ = *other.of_dealii_;
  find_values();
  return *this;
}

Vector &Vector::operator=(Vector &&other) noexcept
{
  swap(other);
  return *this;
}

Vector::~Vector() = default;

void Vector::swap(Vector &other) noexcept
{
  std::swap(of_dealii_, other.of_dealii_);
  std::swap(values_, other.values_);
  std::swap(n_owned_, other.n_owned_);
}

bool Vector::belongs_to(const VectorPartition &partition) const { return of_dealii_->get_partitioner() == partition; }

std::size_t Vector::size() const { return of_dealii_->size(); }

std::size_t Vector::n_local() const { return n_owned_ + of_dealii_->get_partitioner()->n_ghost_indices(); }

std::size_t Vector::global_index(std::size_t local) const
{
  return of_dealii_->get_partitioner()->local_to_global(static_cast<unsigned>(local));
}

std::size_t Vector::first_owned() const { return of_dealii_->get_partitioner()->local_range().first; }

Vector &Vector::operator=(double value)
{
  *of_dealii_ = value;
  return *this;
}

Vector &Vector::operator+=(const Vector &other)
{
  *of_dealii_ += *other.of_dealii_;
  return *this;
}

Vector &Vector::operator-=(const Vector &other)
{
  *of_dealii_ -= *other.of_dealii_;
  return *this;
}

Vector &Vector::operator*=(double factor)
{
  *of_dealii_ *= factor;
  return *this;
}

Vector &Vector::operator/=(double divisor)
{
  *of_dealii_ /= divisor;
  return *this;
}

double Vector::operator*(const Vector &other) const { return *of_dealii_ * *other.of_dealii_; }
double Vector::l1_norm() const { return of_dealii_->l1_norm(); }
double Vector::l2_norm() const { return of_dealii_->l2_norm(); }
double Vector::linfty_norm() const { return of_dealii_->linfty_norm(); }

void Vector::update_ghost_values() const { of_dealii_->update_ghost_values(); }
void Vector::zero_out_ghost_values() const { of_dealii_->zero_out_ghost_values(); }
void Vector::add_ghosts_to_owners() { of_dealii_->compress(dealii::VectorOperation::add); }
} // namespace isostat
