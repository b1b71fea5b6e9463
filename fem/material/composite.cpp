// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/composite.hpp"

#include "base/files/bytes.hpp"

#include <cassert>

namespace isostat
{
namespace
{
template <typename T>
std::vector<T> gathered(std::span<const T> all, const std::vector<std::size_t> &places)
{
  std::vector<T> mine(places.size());
  for (std::size_t k = 0; k < places.size(); ++k)
    mine[k] = all[places[k]];
  return mine;
}

template <typename T>
void scatter(const std::vector<T> &mine, const std::vector<std::size_t> &places, std::span<T> all)
{
  for (std::size_t k = 0; k < places.size(); ++k)
    all[places[k]] = mine[k];
}
/// Where points of a part are in the mesh, for a message that counts them in the part; empty if they count alike.
std::string which(const CompositeMaterial::Part &part)
{
  constexpr std::size_t most = 20;
  bool alike = true;
  std::string places;
  for (std::size_t k = 0; k < part.places.size(); ++k)
    {
      alike &= part.places[k] == k;
      if (k <= most)
        places += (k == 0 ? "" : ", ") + (k == most ? "..." : std::to_string(part.places[k]));
    }
  return alike ? "" : "material '" + part.material->name() + "', whose points are " + places + " of the mesh: ";
}
} // namespace

CompositeMaterial::CompositeMaterial(std::vector<Part> parts) : parts_(std::move(parts))
{
  for (const Part &part : parts_)
    n_points_ += part.places.size();
  std::vector<int> covered(n_points_, 0);
  for (const Part &part : parts_)
    {
      if (!part.material || part.material->n_points() != part.places.size())
        throw InputError("composite: a part has other points than its material");
      for (std::size_t place : part.places)
        if (place >= n_points_ || covered[place]++)
          throw InputError("composite: point " + std::to_string(place) + " has two materials, or is outside");
    }
}

void CompositeMaterial::set_initial_stress(std::span<const Stress> effective)
{
  for (Part &part : parts_)
    part.material->set_initial_stress(gathered<Stress>(effective, part.places));
}

void CompositeMaterial::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points_ && stresses.size() == n_points_);
  for (std::size_t k = 0; k < parts_.size(); ++k)
    {
      std::vector<Stress> mine(parts_[k].places.size());
      try
        {
          parts_[k].material->trial(gathered<Gradient>(increments, parts_[k].places), mine);
        }
      catch (const RunFailure &failure)
        {
          rollback(); // of all: the parts before this one have a trial
          throw RunFailure(which(parts_[k]) + failure.what());
        }
      scatter(mine, parts_[k].places, stresses);
    }
}

void CompositeMaterial::commit()
{
  for (Part &part : parts_)
    part.material->commit();
}

void CompositeMaterial::rollback()
{
  for (Part &part : parts_)
    part.material->rollback();
}

void CompositeMaterial::stiffness(std::span<Stiffness> tangents) const
{
  for (const Part &part : parts_)
    {
      std::vector<Stiffness> mine(part.places.size());
      part.material->stiffness(mine);
      scatter(mine, part.places, tangents);
    }
}

void CompositeMaterial::wave_moduli(std::span<WaveModuli> moduli) const
{
  for (const Part &part : parts_)
    {
      std::vector<WaveModuli> mine(part.places.size());
      part.material->wave_moduli(mine);
      scatter(mine, part.places, moduli);
    }
}

std::vector<std::byte> CompositeMaterial::pack() const
{
  ByteWriter out;
  out.text(name());
  out.count(parts_.size());
  for (const Part &part : parts_)
    {
      out.text(part.material->name());
      out.count(part.places.size());
      out.block(part.material->pack());
    }
  return out.take();
}

void CompositeMaterial::unpack(std::span<const std::byte> bytes)
{
  ByteReader in(bytes, name());
  in.expect(in.text(), name());
  in.expect(in.count(), parts_.size(), "parts");
  std::vector<std::span<const std::byte>> blocks;
  for (const Part &part : parts_) // all headers first: nothing changes unless they fit
    {
      in.expect(in.text(), part.material->name());
      in.expect(in.count(), part.places.size(), "points in a part");
      blocks.push_back(in.block());
    }
  in.expect_end();
  for (std::size_t k = 0; k < parts_.size(); ++k)
    parts_[k].material->unpack(blocks[k]);
}
} // namespace isostat
