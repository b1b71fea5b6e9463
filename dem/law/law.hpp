// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/law/history.hpp"

#include <concepts>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isostat
{
struct Key;      // base/scene/schema.hpp
struct LoopView; // dem/contact/loop.hpp

/// Tangent stiffness of a contact: normal and shear (N/m), against rolling and twisting (N m).
struct ContactStiffness
{
  double normal, shear, rolling, twisting;
};

/// A grain near a rigid wall.
struct WallOverlap
{
  double radius;  ///< m
  double overlap; ///< m; at most 0 where they do not touch
};

/// A rigid wall against a grain.
struct WallResponse
{
  double force;     ///< fn >= 0, N
  double stiffness; ///< its derivative by the overlap, N/m
};

/// One closed contact as measures see it.
struct ClosedContact
{
  double r1, r2, overlap, normal_force; ///< m, m, m, N
  const ContactHistory &history;
};

/// Below a limit by this share a force counts as having reached it: the round-off of the plastic return.
constexpr double yield_round_off = 1e-9;

/// Which limits a contact has reached.
struct YieldState
{
  bool sliding = false, rolling = false;
};

/// Elastic energy of one contact, J.
struct ContactEnergy
{
  double normal = 0, shear = 0, rolling = 0, twisting = 0;
};

/// A contact law for spheres of one material: parameters and equations. Everything outside the folder of a law goes by
/// this interface; one call does a whole chunk of contacts, so the loop over contacts knows its law at compile time.
/// How to add one: CONTRIBUTING.md.
/// tested: tests/dem/law/own_law_test.cpp (a law outside the library: loop, step, scene, files)
struct ContactLaw
{
  // What every law has, since stages and preparation change it.
  double young = 1e10; ///< E, Pa: all stiffness is in proportion to it, and forces are at most of the order E u R
  double friction = 0; ///< mu = tan(phi) between grains [-]; 0: no tangential force, no torque. Walls have none

  using KeyRoot = ContactLaw; ///< where keys look for the members of a law (base/scene/field.hpp)

  virtual ~ContactLaw() = default;
  virtual const char *name() const = 0; ///< as `contact.law` in scenes
  virtual std::unique_ptr<ContactLaw> clone() const = 0;
  /// The parameters as keys of the section [contact], "young"; fields are doubles and bools,
  /// member<&MyLaw::parameter>. Names in files and bytes, keys of caches and equality of laws follow from this table.
  virtual std::span<const Key> keys() const = 0;

  /// What the present parameters need to remember of a contact.
  virtual HistoryLayout history() const = 0;
  /// Forces of all pairs of one chunk, added up, history advanced: Loop<...>::run() of loop-inl.hpp.
  virtual void add_forces(const LoopView &view) const = 0;

  // Two grains, radii and overlap u >= 0 in m.
  virtual double normal_force(double r1, double r2, double overlap) const = 0; ///< N, repulsion positive
  /// For the critical time step and the stiffness of packings; elastic, whether the contact yields or not. Springs that
  /// are switched off have none.
  virtual ContactStiffness stiffness(double r1, double r2, double overlap) const = 0;
  /// @param margin  share of a limit by which the force or moment may be below it [-], in [0, 1)
  virtual YieldState yield(const ClosedContact &contact, double margin) const = 0;
  virtual ContactEnergy energy(const ClosedContact &contact) const = 0;

  /// kn/R of two equal grains of radius R in a packing under this pressure, Pa; of the order of its elastic moduli.
  virtual double modulus(double /*pressure*/) const { return young; }

  // A grain against a rigid wall without friction.
  virtual WallResponse wall(double radius, double overlap) const = 0;
  /// All grains near a wall at once, 0 for those that do not touch it. In the loop: a law that answers without a branch
  /// per grain overrides it.   @pre one response per grain
  virtual void walls(std::span<const WallOverlap> near, std::span<WallResponse> responses) const;
  virtual double wall_energy(double radius, double overlap, double normal_force) const = 0; ///< J

protected:
  ContactLaw() = default;
  ContactLaw(const ContactLaw &) = default;
  ContactLaw &operator=(const ContactLaw &) = default;
};

/// A law as a value: a copy has parameters of its own.
class Law
{
public:
  Law(); ///< the default law with its default parameters: the first of dem/contact/laws.cpp
  template <std::derived_from<ContactLaw> Concrete>
  Law(const Concrete &law) : law_(law.clone())
  {}
  Law(const Law &other) : law_(other.law_->clone()) {}
  Law(Law &&) noexcept = default;
  Law &operator=(const Law &other) { return *this = Law(other); }
  Law &operator=(Law &&) noexcept = default;

  ContactLaw *operator->() { return law_.get(); }
  const ContactLaw *operator->() const { return law_.get(); }
  operator const ContactLaw &() const { return *law_; }

  /// The law by its type.   @pre it is of this type
  template <std::derived_from<ContactLaw> Concrete>
  Concrete &as()
  {
    return dynamic_cast<Concrete &>(*law_);
  }
  template <std::derived_from<ContactLaw> Concrete>
  const Concrete &as() const
  {
    return dynamic_cast<const Concrete &>(*law_);
  }

  bool operator==(const Law &other) const; ///< the same law with the same parameters, to the bit

private:
  std::unique_ptr<ContactLaw> law_;
};

/// Numbers, then switches as 0 or 1, of a law, in the order of for_each_parameter (parameters.hpp).
std::vector<double> parameter_values(const ContactLaw &law);

/// All laws that scenes and files may name: those of dem/contact/laws.cpp, then those that a program has registered.
std::span<const Law> registered_laws();
/// Adds a law, with the parameters that it has where a file leaves them out. @pre no scene has been read yet
void register_law(const Law &law);
/// @throws InputError  no law of that name: lists those that there are
Law law_named(std::string_view name);
/// The law of scenes and files that name none.
bool is_default(const ContactLaw &law);
} // namespace isostat
