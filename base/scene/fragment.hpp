// SPDX-License-Identifier: BSD-3-Clause
// Keys of one concept, written once beside its struct and spliced into every kind of scene that has one.
#pragma once
#include "base/scene/schema.hpp"

#include <deque>
#include <initializer_list>

namespace isostat
{
/// The keys of a struct that several kinds of scene contain. Paths have no section ("damping"; none: the table itself),
/// fields are those of the struct, kinds are left to the scene.
///
///     fem/water/pore_fluid_scene.hpp  SceneFragment<Water> pore_fluid_keys();
///     apps/deposit/schema.cpp         KeyTable table{title_key,
///                                                    splice<&ColumnScene::water>("water", pore_fluid_keys())};
template <class Part>
struct SceneFragment
{
  std::span<const Key> keys;
};

/// Keys that stand together in a table, and where they belong.
struct KeyRun
{
  template <std::size_t n>
  KeyRun(const Key (&own)[n]) : keys(own)
  {}
  KeyRun(std::span<const Key> keys_, std::string section_ = {}, unsigned kinds_ = 0, PartAccess part_ = {})
      : keys(keys_), section(std::move(section_)), kinds(kinds_), part(part_)
  {}

  std::span<const Key> keys;
  std::string section;  ///< before their paths; empty: as they are
  unsigned kinds = 0;   ///< of the section that take them; 0: as they say
  PartAccess part = {}; ///< where their struct is; none: their fields are those of the scene itself
};

/// The keys of a fragment in a section of a scene, or (no section) in a larger fragment.
/// @param kinds  bits of the kinds of the section that take them; 0: all of them
/// @param part  lambda without captures, (Whole &) -> Part &; Whole: what an entry of an array of tables becomes, else
///        the scene
template <class Part, class Lambda>
KeyRun splice(std::string section, SceneFragment<Part> fragment, unsigned kinds, Lambda part)
{
  return {fragment.keys, std::move(section), kinds, part};
}
/// The same of a struct that is a member, or a member of its member.
template <auto first, auto... others, class Part>
KeyRun splice(std::string section, SceneFragment<Part> fragment, unsigned kinds = 0)
{
  using Whole = typename detail::Member<first>::Struct;
  return splice(std::move(section), fragment, kinds,
                [](Whole &whole) -> Part & { return detail::member_in<first, others...>(whole); });
}
template <auto first, auto... others, std::size_t n>
KeyRun splice(std::string section, const Key (&own)[n], unsigned kinds = 0)
{
  using Whole = typename detail::Member<first>::Struct;
  using Part = std::remove_reference_t<decltype(detail::member_in<first, others...>(std::declval<Whole &>()))>;
  return splice<first, others...>(std::move(section), SceneFragment<Part>{own}, kinds);
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
