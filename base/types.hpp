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
