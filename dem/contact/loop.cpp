// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/loop.hpp"

namespace isostat
{
void add_contact_forces(const ContactLaw &law, const Packing &packing, double dt, ContactList &list, std::size_t chunk,
                        double *action, DissipationPerPair *dissipation, const CellMotion *cell, double contact_damping)
{
  LoopView view{.position = packing.position.data(),
                .velocity = packing.velocity.data(),
                .spin = packing.spin.data(),
                .first = list.first(),
                .second = list.second(),
                .target = list.target(),
                .history = list.history_data(),
                .action = action,
                .occupied = list.occupied(),
                .begin = list.first_block(chunk),
                .end = list.first_block(chunk + 1),
                .dt = dt,
                .contact_damping = contact_damping};
  if (list.image())
    {
      const Mat3 &e = cell->strain_step;
      const double steps[] = {e(0, 0), e(1, 1), e(2, 2), e(1, 2), e(0, 2), e(0, 1)};
      for (int c = 0; c < 6; ++c)
        view.rate[c] = steps[c] / dt;
      view.image = list.image();
      view.offsets = list.offsets();
      view.virial = cell->virial->data(chunk);
      view.virial_start = cell->virial->grid();
    }
  if (dissipation)
    {
      dissipation->clear(view.begin * ContactList::lanes, view.end * ContactList::lanes);
      view.sliding = dissipation->sliding.data();
      view.rolling = dissipation->rolling.data();
      view.released = dissipation->released.data();
      view.created = dissipation->created.data();
      view.viscous = dissipation->viscous.data();
    }
  law.add_forces(view);
}

void add_contact_forces(const ContactLaw &law, const Packing &packing, double dt, ContactList &list, double *action,
                        DissipationPerPair *dissipation, const CellMotion *cell, double contact_damping)
{
  if (dissipation)
    dissipation->resize(list.n_lanes());
  for (std::size_t chunk = 0; chunk < list.partition().n_chunks; ++chunk)
    add_contact_forces(law, packing, dt, list, chunk, action, dissipation, cell, contact_damping);
  for (std::size_t chunk = 0; chunk < list.partition().n_chunks; ++chunk)
    add_ghosts(list, chunk, action);
}
} // namespace isostat
