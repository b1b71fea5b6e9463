// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/history.hpp"

namespace isostat
{
ContactHistory ContactList::history(std::size_t pair) const
{
  ContactHistory h;
  if (!features_.friction)
    return h;
  auto vector_at = [&](std::size_t c) {
    return Vec3(*component(pair, c), *component(pair, c + 1), *component(pair, c + 2));
  };
  h.normal = vector_at(0);
  h.shear_force = vector_at(3);
  if (features_.rolling)
    h.bending_moment = vector_at(6);
  if (features_.twisting)
    h.twisting_moment = vector_at(features_.rolling ? 9 : 6);
  return h;
}

void ContactList::set_history(std::size_t pair, const ContactHistory &h)
{
  if (!features_.friction)
    return;
  auto put = [&](std::size_t c, const Vec3 &v) {
    for (std::size_t k = 0; k < 3; ++k)
      *component(pair, c + k) = v[k];
  };
  put(0, h.normal);
  put(3, h.shear_force);
  if (features_.rolling)
    put(6, h.bending_moment);
  if (features_.twisting)
    put(features_.rolling ? 9 : 6, h.twisting_moment);
  occupied_[pair / lanes] = 1;
}

void ContactList::replace_pairs(const std::vector<Pair> &sorted_pairs, std::uint32_t n_grains)
{
  ContactList next(features_);
  next.n_pairs_ = sorted_pairs.size();
  const std::size_t n_blocks = (sorted_pairs.size() + lanes - 1) / lanes;
  next.first_.assign(n_blocks * lanes, n_grains);
  next.second_.assign(n_blocks * lanes, n_grains + 1);
  next.history_.assign(n_blocks * lanes * n_components(), 0.0);
  next.occupied_.assign(n_blocks, 0);

  std::size_t old = 0;
  for (std::size_t pair = 0; pair < sorted_pairs.size(); ++pair)
    {
      const Pair key = sorted_pairs[pair];
      next.first_[pair] = key.first;
      next.second_[pair] = key.second;
      while (old < n_pairs_ && Pair(first_[old], second_[old]) < key)
        ++old;
      if (old < n_pairs_ && Pair(first_[old], second_[old]) == key && occupied_[old / lanes])
        next.set_history(pair, history(old));
    }
  *this = std::move(next);
}

void ContactList::set_features(LawFeatures active)
{
  if (active == features_)
    return;
  ContactList next(active);
  next.n_pairs_ = n_pairs_;
  next.first_ = first_;
  next.second_ = second_;
  next.history_.assign(first_.size() * n_components(active), 0.0);
  next.occupied_.assign(occupied_.size(), 0);
  for (std::size_t pair = 0; pair < n_pairs_; ++pair)
    next.set_history(pair, history(pair));
  *this = std::move(next);
}
} // namespace isostat
