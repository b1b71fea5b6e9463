// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/material.hpp"

#include "base/files/bytes.hpp"

#include <cassert>

namespace isostat
{
namespace
{
/// Calls f(part, first point, number of points) for each part.
template <typename Parts, typename F>
void for_each_part(Parts &parts, const F &f)
{
  std::size_t first = 0;
  for (auto &part : parts)
    {
      f(*part, first, part->n_points());
      first += part->n_points();
    }
}

std::string place(const Material &part, std::size_t first)
{
  return "layer of '" + part.name() + "' from point " + std::to_string(first) + " on: ";
}
} // namespace

LayeredMaterial::LayeredMaterial(std::vector<std::unique_ptr<Material>> parts) : parts_(std::move(parts))
{
  for (const auto &part : parts_)
    {
      if (!part)
        throw InputError("layered material: a layer has no material; give each layer one");
      n_points_ += part->n_points();
    }
}

std::string LayeredMaterial::name() const { return "layered"; }

void LayeredMaterial::set_initial_stress(std::span<const Stress> effective)
{
  assert(effective.size() == n_points_);
  for_each_part(parts_, [&](Material &part, std::size_t first, std::size_t n) {
    try
      {
        part.set_initial_stress(effective.subspan(first, n));
      }
    catch (const InputError &e)
      {
        throw InputError(place(part, first) + e.what());
      }
  });
}

void LayeredMaterial::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points_ && stresses.size() == n_points_);
  for_each_part(parts_, [&](Material &part, std::size_t first, std::size_t n) {
    try
      {
        part.trial(increments.subspan(first, n), stresses.subspan(first, n));
      }
    catch (const RunFailure &e)
      {
        rollback(); // of all: the parts before this one have a trial
        throw RunFailure(place(part, first) + e.what());
      }
  });
}

void LayeredMaterial::commit()
{
  for (auto &part : parts_)
    part->commit();
}

void LayeredMaterial::rollback()
{
  for (auto &part : parts_)
    part->rollback();
}

void LayeredMaterial::stiffness(std::span<Stiffness> tangents) const
{
  for_each_part(parts_, [&](const Material &part, std::size_t first, std::size_t n) {
    part.stiffness(tangents.subspan(first, n));
  });
}

void LayeredMaterial::wave_moduli(std::span<WaveModuli> moduli) const
{
  for_each_part(parts_, [&](const Material &part, std::size_t first, std::size_t n) {
    part.wave_moduli(moduli.subspan(first, n));
  });
}

std::vector<std::byte> LayeredMaterial::pack() const
{
  ByteWriter out;
  out.text(name());
  out.count(parts_.size());
  for (const auto &part : parts_)
    {
      out.text(part->name());
      out.count(part->n_points());
      out.block(part->pack());
    }
  return out.take();
}

void LayeredMaterial::unpack(std::span<const std::byte> bytes)
{
  ByteReader in(bytes, name());
  in.expect(in.text(), name());
  in.expect(in.count(), parts_.size(), "layers");
  std::vector<std::span<const std::byte>> blocks;
  for (const auto &part : parts_) // all headers first: nothing changes unless they fit
    {
      in.expect(in.text(), part->name());
      in.expect(in.count(), part->n_points(), "points in a layer");
      blocks.push_back(in.block());
    }
  in.expect_end();
  for (std::size_t k = 0; k < parts_.size(); ++k)
    parts_[k]->unpack(blocks[k]);
}
} // namespace isostat
