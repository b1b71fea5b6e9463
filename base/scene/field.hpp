// SPDX-License-Identifier: BSD-3-Clause
// Where the value of a key lives in the program.
// tested: tests/base/scene/fragment_test.cpp
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace isostat
{
struct PercentPair
{
  double *low, *high;
};
using SizeCurve = std::vector<std::pair<double, double>>;

/// A pointer to an enumeration whose values 0, 1, ... are the words of the key in their order, or to a variant whose
/// alternatives are: setting it makes the alternative with its defaults.
class EnumField
{
public:
  template <class Enum>
  requires std::is_enum_v<Enum> EnumField(Enum *place)
      : place_(place), get_([](const void *p) { return static_cast<std::size_t>(*static_cast<const Enum *>(p)); }),
        set_([](void *p, std::size_t word) { *static_cast<Enum *>(p) = static_cast<Enum>(word); })
  {}
  template <class... Kinds>
  EnumField(std::variant<Kinds...> *place)
      : place_(place), get_([](const void *p) { return static_cast<const std::variant<Kinds...> *>(p)->index(); }),
        set_([](void *p, std::size_t word) {
          static const std::variant<Kinds...> kinds[] = {Kinds{}...};
          *static_cast<std::variant<Kinds...> *>(p) = kinds[word];
        })
  {}

  /// Of a place that is no enumeration but has a number all the same.
  EnumField(void *place, std::size_t (*get)(const void *), void (*set)(void *, std::size_t))
      : place_(place), get_(get), set_(set)
  {}

  std::size_t get() const { return get_(place_); }
  void set(std::size_t word) const { set_(place_, word); }

private:
  void *place_;
  std::size_t (*get_)(const void *);
  void (*set_)(void *, std::size_t);
};

/// monostate: nowhere (a table that only holds others).
using Field = std::variant<std::monostate, double *, std::optional<double> *, std::uint64_t *, unsigned *, bool *,
                           std::string *, EnumField, std::vector<double> *, PercentPair, SizeCurve *>;

namespace detail
{
/// A lambda (First &) or (First &, Second &) of an empty type as a function of forgotten types.
template <class Result, class Lambda, class Returned, class First, class Second>
constexpr auto erased(Returned (Lambda::*)(First &, Second &) const) -> Result (*)(void *, void *)
{
  return [](void *first, void *second) -> Result {
    return Lambda{}(*static_cast<First *>(first), *static_cast<Second *>(second));
  };
}
template <class Result, class Lambda, class Returned, class First>
constexpr auto erased(Returned (Lambda::*)(First &) const) -> Result (*)(void *, void *)
{
  return [](void *first, void *) -> Result { return Lambda{}(*static_cast<First *>(first)); };
}
} // namespace detail

/// Where the struct of a fragment (base/scene/fragment.hpp) lies in a scene: made from a lambda without captures,
/// (Scene &) -> Part &, or (Scene &, Item &) -> Part &. The types are forgotten.
class PartAccess
{
public:
  constexpr PartAccess() = default;
  template <class Lambda>
  requires std::is_empty_v<Lambda>
  constexpr PartAccess(Lambda) : call_(detail::erased<Reference>(&Lambda::operator())) {}

  void *operator()(void *scene, void *item) const { return call_(scene, item).place; }
  constexpr explicit operator bool() const { return call_ != nullptr; }

private:
  struct Reference
  {
    void *place;
    template <class Part>
    Reference(Part &part) : place(&part)
    {}
  };
  Reference (*call_)(void *, void *) = nullptr;
};

/// How a key finds its field: made from a lambda without captures, (Scene &) -> Field, or (Scene &, Item &) -> Field
/// where Item is what an entry of the key's array of tables becomes. The types are forgotten, so that one machinery
/// reads every kind of scene; who calls it must pass objects of those types.
class FieldAccess
{
public:
  constexpr FieldAccess() = default;
  template <class Lambda>
  requires std::is_empty_v<Lambda>
  constexpr FieldAccess(Lambda) : call_(detail::erased<Field>(&Lambda::operator())) {}

  template <class Scene, class Item>
  requires(!std::is_pointer_v<Scene> && !std::is_pointer_v<Item>) Field operator()(Scene &scene, Item &item) const
  {
    return (*this)(static_cast<void *>(&scene), static_cast<void *>(&item));
  }
  Field operator()(void *scene, void *item) const
  {
    for (std::size_t i = n_parts_; i-- > 0; item = nullptr)
      scene = parts_[i](scene, item);
    return call_(scene, item);
  }
  constexpr explicit operator bool() const { return call_ != nullptr; }

  /// The same field of a struct that lies within a larger one.   @pre at most three levels
  constexpr FieldAccess within(PartAccess part) const
  {
    FieldAccess access = *this;
    access.parts_[access.n_parts_++] = part;
    return access;
  }

private:
  Field (*call_)(void *, void *) = nullptr;
  std::array<PartAccess, 3> parts_ = {}; ///< from the innermost outwards
  std::size_t n_parts_ = 0;
};

/// How the entries of an array of tables are reached in a scene.
struct ItemAccess
{
  std::size_t (*count)(const void *scene) = nullptr;
  void *(*at)(void *scene, std::size_t i) = nullptr;
  void *(*add)(void *scene) = nullptr; ///< one more, with the defaults of its struct

  constexpr explicit operator bool() const { return count != nullptr; }
};

namespace detail
{
template <class Scene, class Item, std::vector<Item> Scene::*member>
struct Items
{
  static constexpr ItemAccess access{
      [](const void *scene) { return (static_cast<const Scene *>(scene)->*member).size(); },
      [](void *scene, std::size_t i) -> void * { return &(static_cast<Scene *>(scene)->*member)[i]; },
      [](void *scene) -> void * { return &(static_cast<Scene *>(scene)->*member).emplace_back(); }};
};

template <class Scene, class Item>
Scene scene_of(std::vector<Item> Scene::*);
template <class Scene, class Item>
Item item_of(std::vector<Item> Scene::*);
} // namespace detail

/// items_of<&Scene::stages>: of a vector in the scene.
template <auto member>
inline constexpr ItemAccess items_of =
    detail::Items<decltype(detail::scene_of(member)), decltype(detail::item_of(member)), member>::access;
} // namespace isostat
