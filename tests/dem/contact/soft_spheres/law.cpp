// SPDX-License-Identifier: BSD-3-Clause
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/dem/contact/soft_spheres/law.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dem/contact/loop-inl.hpp"
#include "dem/law/parameters.hpp"
#include "tests/dem/contact/soft_spheres/law.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
struct SoftSpheresLanes
{
  struct Numbers
  {
    double twice_modulus; ///< 2 softness E
  };
  static constexpr bool is_central = true;
  static constexpr std::size_t n_components = 0;

  static HWY_INLINE V normal_stiffness(const Numbers &k, const Pairs &p)
  {
    return closed(p, hn::Mul(hn::Mul(p.r1, p.r2), hn::Mul(inverse(p.reach), hn::Set(D(), k.twice_modulus))));
  }
  static HWY_INLINE V normal_force(const Numbers &k, const Pairs &p)
  {
    return hn::Mul(normal_stiffness(k, p), p.overlap);
  }
};

void AddSoftSpheres(double twice_modulus, const LoopView &view) { run_loop<SoftSpheresLanes>(view, {twice_modulus}); }
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
HWY_EXPORT(AddSoftSpheres);

namespace test
{
namespace
{
constexpr Key keys_of_law[] = {{.path = "young",
                                .field = member<&SoftSpheres::young>,
                                .unit = unit::GPa,
                                .value = "10 GPa",
                                .range = {0, 1e15, true},
                                .text = "Modulus of the material."},
                               {.path = "softness",
                                .field = member<&SoftSpheres::softness>,
                                .value = "0.1",
                                .range = {0, 1, true},
                                .reason = "because no sphere is stiffer than its material",
                                .text = "Modulus of the contact over that of the material."}};
} // namespace

std::span<const Key> SoftSpheres::keys() const { return keys_of_law; }

void SoftSpheres::add_forces(const LoopView &view) const
{
  HWY_DYNAMIC_DISPATCH(AddSoftSpheres)(2 * softness * young, view);
}
} // namespace test
} // namespace isostat
#endif
