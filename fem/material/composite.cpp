// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/composite.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace isostat
{
namespace
{
/// f(entries of a part): those of `all` themselves if they lie side by side, else a copy in the part's order, which is
/// copied back unless it is constant.
template <typename Member, typename T, typename F>
void with_entries(const Member &part, std::span<T> all, const F &f)
{
  if (part.side_by_side)
    return f(part.places.empty() ? all.first(0) : all.subspan(part.places.front(), part.places.size()));
  std::vector<std::remove_const_t<T>> own;
  for (std::size_t place : part.places)
    own.push_back(all[place]);
  f(std::span<T>(own));
  if constexpr (!std::is_const_v<T>)
    for (std::size_t k = 0; k < own.size(); ++k)
      all[part.places[k]] = own[k];
}

/// For messages: nothing if the part's numbers are the mesh's.
template <typename Member>
std::string which(const Member &part)
{
  constexpr std::size_t max_named = 20;
  if (part.side_by_side && (part.places.empty() || part.places.front() == 0))
    return "";
  std::string places;
  if (part.side_by_side)
    places = std::to_string(part.places.front()) + " to " + std::to_string(part.places.back());
  else
    for (std::size_t k = 0; k < std::min(part.places.size(), max_named + 1); ++k)
      places += (k == 0 ? "" : ", ") + (k == max_named ? "..." : std::to_string(part.places[k]));
  return "material '" + part.material->name() + "', whose points are " + places + " of the mesh: ";
}
} // namespace

CompositeMaterial::CompositeMaterial(std::vector<Part> parts)
{
  for (const Part &part : parts)
    n_points_ += part.places.size();
  std::vector<int> covered(n_points_, 0);
  for (Part &part : parts)
    {
      if (!part.material || part.material->n_points() != part.places.size())
        throw InputError("composite: a part has other points than its material");
      bool side_by_side = true;
      for (std::size_t k = 0; k < part.places.size(); ++k)
        {
          const std::size_t place = part.places[k];
          if (place >= n_points_ || covered[place]++)
            throw InputError("composite: point " + std::to_string(place) + " has two materials, or is outside");
          side_by_side &= place == part.places.front() + k;
        }
      parts_.push_back({std::move(part), side_by_side});
    }
}

std::unique_ptr<Material> stacked(std::vector<std::unique_ptr<Material>> materials)
{
  std::vector<CompositeMaterial::Part> parts;
  std::size_t first = 0;
  for (auto &material : materials)
    {
      if (!material)
        throw InputError("stacked materials: a layer has no material; give each layer one");
      std::vector<std::size_t> places(material->n_points());
      std::iota(places.begin(), places.end(), first);
      first += places.size();
      parts.push_back({std::move(material), std::move(places)});
    }
  return std::make_unique<CompositeMaterial>(std::move(parts));
}

void CompositeMaterial::set_time_step(double seconds)
{
  for (const Member &part : parts_)
    part.material->set_time_step(seconds);
}

void CompositeMaterial::set_initial_stress(std::span<const Stress> effective)
{
  assert(effective.size() == n_points_);
  for (const Member &part : parts_)
    try
      {
        with_entries(part, effective, [&](std::span<const Stress> own) { part.material->set_initial_stress(own); });
      }
    catch (const InputError &error)
      {
        throw InputError(which(part) + error.what());
      }
}

void CompositeMaterial::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points_ && stresses.size() == n_points_);
  for (const Member &part : parts_)
    try
      {
        with_entries(part, increments, [&](std::span<const Gradient> own) {
          with_entries(part, stresses, [&](std::span<Stress> found) { part.material->trial(own, found); });
        });
      }
    catch (const RunFailure &failure)
      {
        rollback(); // of all: the parts before this one have a trial
        throw RunFailure(which(part) + failure.what());
      }
}

void CompositeMaterial::commit()
{
  for (const Member &part : parts_)
    part.material->commit();
}

void CompositeMaterial::rollback()
{
  for (const Member &part : parts_)
    part.material->rollback();
}

void CompositeMaterial::stiffness(std::span<Stiffness> tangents) const
{
  for (const Member &part : parts_)
    with_entries(part, tangents, [&](std::span<Stiffness> own) { part.material->stiffness(own); });
}

void CompositeMaterial::wave_moduli(std::span<WaveModuli> moduli) const
{
  for (const Member &part : parts_)
    with_entries(part, moduli, [&](std::span<WaveModuli> own) { part.material->wave_moduli(own); });
}

MaterialState CompositeMaterial::pack() const
{
  MaterialState state;
  state.points.resize(n_points_);
  ByteWriter out;
  out.text(name());
  out.count(parts_.size());
  for (const Member &part : parts_)
    {
      MaterialState of_part = part.material->pack();
      out.text(part.material->name());
      out.count(of_part.points.empty() && !part.places.empty()); // as a whole
      out.block(of_part.common);
      for (std::size_t k = 0; k < of_part.points.size(); ++k)
        state.points[part.places[k]] = std::move(of_part.points[k]);
    }
  state.common = out.take();
  return state;
}

void CompositeMaterial::unpack(const MaterialState &state)
{
  ByteReader in(state.common, name());
  in.expect(in.text(), name());
  in.expect(in.count(), parts_.size(), "parts");
  in.expect(state.points.size(), n_points_, "points");
  std::vector<MaterialState> states;
  for (const Member &part : parts_) // all headers first: nothing changes unless they fit
    {
      in.expect(in.text(), part.material->name());
      const bool as_a_whole = in.count() != 0;
      const auto common = in.block();
      states.push_back({{common.begin(), common.end()}, {}});
      for (std::size_t k = 0; !as_a_whole && k < part.places.size(); ++k)
        states.back().points.push_back(state.points[part.places[k]]);
    }
  in.expect_end();
  for (std::size_t k = 0; k < parts_.size(); ++k)
    parts_[k].material->unpack(states[k]);
}
} // namespace isostat
