// SPDX-License-Identifier: BSD-3-Clause
// Keys of one concept, written once next to its struct and spliced into every kind of scene that has one.
#pragma once
#include "base/scene/schema.hpp"

#include <deque>
#include <initializer_list>

namespace isostat
{
/// The keys of a struct that several kinds of scene contain. Paths have no section ("damping"), fields are made from
/// lambdas (Part &) -> Field, kinds are left to the scene.
///
///     fem/material/iwan_scene.hpp     SceneFragment<IwanParameters> iwan_keys();
///     apps/deposit/schema.cpp         KeyTable table{own_keys,
///                                                    splice("layer", iwan_keys(), bit(LayerMaterial::iwan),
///                                                           [](Scene &, Layer &l) -> auto & { return l.iwan; })};
template <class Part>
struct SceneFragment
{
  std::span<const Key> keys;
};

/// Keys that belong together in a table, and where they belong.
struct KeyRun
{
  template <std::size_t n>
  KeyRun(const Key (&own)[n]) : keys(own)
  {}
  KeyRun(std::span<const Key> keys_, std::string section_, unsigned kinds_, PartAccess part_)
      : keys(keys_), section(std::move(section_)), kinds(kinds_), part(part_)
  {}

  std::span<const Key> keys;
  std::string section;  ///< before their paths; empty: as they are
  unsigned kinds = 0;   ///< of the section that take them; 0: as they say
  PartAccess part = {}; ///< where their struct is; none: their fields are those of the scene itself
};

namespace detail
{
template <class Lambda, class Returned, class... Arguments>
Returned returned_by(Returned (Lambda::*)(Arguments...) const);
} // namespace detail

/// The keys of a fragment in a section of a scene, or (no section) in a larger fragment.
/// @param kinds  bits of the kinds of the section that take them; 0: all of them
/// @param part  lambda without captures, (Scene &) -> Part &, or (Scene &, Item &) -> Part &
template <class Part, class Lambda>
KeyRun splice(std::string section, SceneFragment<Part> fragment, unsigned kinds, Lambda part)
{
  static_assert(std::is_same_v<decltype(detail::returned_by(&Lambda::operator())), Part &>);
  return {fragment.keys, std::move(section), kinds, part};
}

/// The keys of a kind of scene, or of a fragment made of others, in the order in which they are written.
/// tested: tests/base/scene/fragment_test.cpp
class KeyTable
{
public:
  KeyTable(std::initializer_list<KeyRun> runs) : KeyTable(std::span(runs)) {}
  explicit KeyTable(std::span<const KeyRun> runs);
  KeyTable(const KeyTable &) = delete; // keys point at the paths
  KeyTable &operator=(const KeyTable &) = delete;

  std::span<const Key> keys() const { return keys_; }

private:
  std::vector<Key> keys_;
  std::deque<std::string> paths_;
};
} // namespace isostat
