// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/domain/periodic_cell_test.cpp, as every user of these aliases
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

namespace isostat
{
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// The matrix of n x (..).   tested: tests/verification/critical_step_test.cpp, tests/dem/measure/stiffness_test.cpp
inline Mat3 cross_matrix(const Vec3 &n)
{
  Mat3 m;
  m << 0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0;
  return m;
}

/// Allocator for 64-byte aligned storage: one cache line, one AVX-512 vector.
template <typename T>
struct CacheAligned
{
  using value_type = T;
  CacheAligned() = default;
  template <typename U>
  CacheAligned(const CacheAligned<U> &)
  {}
  T *allocate(std::size_t n) { return static_cast<T *>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T *p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  template <typename U>
  bool operator==(const CacheAligned<U> &) const
  {
    return true;
  }
};

template <typename T>
using AlignedVector = std::vector<T, CacheAligned<T>>;
} // namespace isostat
